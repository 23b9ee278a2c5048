"""The page of every key of a scene, from the JSON Schema that the program itself goes by."""

import json
import re
import textwrap

import cells

HEAD = """# Every key of a scene

Made by scripts/docs from host/scene/scene.schema.json, the schema that the program itself checks scenes with; not to be
edited. [../scene.md](../scene.md) is the introduction, with an example and what a table cannot say.

The first column is the JSON pointer, as `--set` and messages use it; `N` stands for the place in a list, from 0, `NAME`
for a name of the author's. **Bold** keys must be there where the object is that holds them. A *quantity* is text with a
unit, of the dimension of the unit that is given here (of a model's parameter: see [models.md](models.md)); a plain
number is taken in that unit. A *vector* is a list of two quantities, along x and y; in
three dimensions of three, the last along z.
"""
FILE_KEYS = ("rouleau", "title", "notes", "expected", "$schema", "plugin_dirs")


def resolved(schema, rule):
    """A rule with what it refers to; what stands beside the reference speaks of this use and wins."""
    while "$ref" in rule:
        own = {key: value for key, value in rule.items() if key != "$ref"}
        rule = {**schema["definitions"][rule["$ref"].rsplit("/", 1)[1]], **own}
    return rule


def is_quantity(schema, rule):
    return resolved(schema, rule).get("type") == schema["definitions"]["quantity"]["type"]


def limits(rule):
    low = [f"above {rule['exclusiveMinimum']:g}"] if "exclusiveMinimum" in rule else []
    low += [f"{rule['minimum']:.10g}"] if "minimum" in rule else []
    high = f"{rule['maximum']:.10g}" if "maximum" in rule else ""
    if low and high:
        return f", {low[0]} to {high}" if "minimum" in rule else f", {low[0]}, at most {high}"
    return f", {low[0]}" + (" or more" if "minimum" in rule else "") if low else ""


def type_of(schema, rule):
    rule = resolved(schema, rule)
    if "enum" in rule:
        return " or ".join(f'`"{word}"`' for word in rule["enum"])
    if "const" in rule:
        return f"`{json.dumps(rule['const'])}`"
    if "oneOf" in rule:
        return " or ".join(dict.fromkeys(type_of(schema, branch) for branch in rule["oneOf"]))
    if is_quantity(schema, rule):
        return "quantity" + (f", {rule['unit']}" if "unit" in rule else "")
    kind = rule["type"]
    if kind == "array":
        items = resolved(schema, rule["items"])
        if is_quantity(schema, items):
            return f"vector, {rule['unit']}"
        if rule.get("minItems") == rule.get("maxItems") == 2:
            return "two of: " + type_of(schema, items)
        return "list of " + ("objects" if items.get("type") == "object" else type_of(schema, items))
    if isinstance(kind, list):
        return " or ".join({"string": "text"}.get(name, name) for name in kind)
    return {"string": "text", "integer": "whole number", "number": "number", "boolean": "true or false", "object": "object"}[
        kind] + limits(rule)


def meaning(rule):
    text = rule.get("markdownDescription", rule.get("description", ""))
    if "default" in rule:  # it has a column of its own
        text = re.sub(r"[;.,] [^;.,]*(?:0\.[0-9]+)?[^;.,]* when left out(?=[.;:,]|$)", "", text)
        text = text.replace(" (when left out)", "")
    return text.replace("|", "\\|")


def rows(schema, rule, pointer, required):
    """Rows of one key and of all below it."""
    rule = resolved(schema, rule)
    default = f"`{json.dumps(rule['default'])}`" if "default" in rule else ""
    name = f"**`{pointer}`**" if required else f"`{pointer}`"
    result = [(name, type_of(schema, rule), default, meaning(rule))]
    return result + children(schema, rule, pointer)


def children(schema, rule, pointer):
    result = []
    seen = set()
    branches = [resolved(schema, branch) for branch in rule.get("oneOf", [])]
    objects = [branch for branch in branches if branch.get("type") == "object"] or [rule]
    for branch in [rule, *branches]:
        for key, below in branch.get("properties", {}).items():
            if key in seen:
                continue  # the branches of a choice share some keys
            seen.add(key)
            required = all(key in o.get("required", []) for o in objects)
            result += rows(schema, below, f"{pointer}/{key}", required)
    extra = rule.get("additionalProperties")
    if isinstance(extra, dict) and extra:
        below = resolved(schema, extra)
        if below.get("type") == "object":
            result += children(schema, below, f"{pointer}/NAME")
        else:
            result += rows(schema, extra, f"{pointer}/NAME", False)
    for branch in [rule, *branches]:
        items = resolved(schema, branch["items"]) if branch.get("type") == "array" else {}
        if items.get("type") == "object":
            result += children(schema, items, f"{pointer}/N")
    return result


def table(rows_of_table):
    return cells.table(["key", "type", "default", "meaning"], rows_of_table)


def page(path):
    schema = json.loads(path.read_text())
    top = schema["properties"]
    text = HEAD + "\n## The file\n\n"
    text += table([row for key in FILE_KEYS for row in rows(schema, top[key], f"/{key}", key in schema["required"])])
    for key in top:
        if key in FILE_KEYS:
            continue
        rule = resolved(schema, top[key])
        required = " Required." if key in schema["required"] else ""
        lists = [branch for branch in (rule, *rule.get("oneOf", [])) if branch.get("type") == "array"]
        of_each = " " + meaning(resolved(schema, lists[0]["items"])) if lists else ""
        lead = textwrap.fill(f"{meaning(rule)}{of_each}{required}", 140, break_long_words=False, break_on_hyphens=False)
        text += f"\n## {key}\n\n{lead}\n\n" + table(children(schema, rule, f"/{key}"))
    return text

"""The page of everything that `import rouleau` has, from its source: signatures and docstrings, without importing it."""

import ast
import re
import textwrap

HEAD = """# Everything in `import rouleau`

Made by scripts/docs from the package's docstrings; not to be edited. [../python.md](../python.md) is the introduction, with examples.
Quantities are in SI units, unless a name says otherwise.
"""
GROUPS = {
    "Running": ["running"],
    "Reading": ["reading"],
    "Sweeps, means and calibration": ["sweeping", "means", "calibrating", "breaking"],
    "Comparing": ["comparing"],
    "Stepping": ["simulation"],
    "Models and walls": ["potentials", "shapes"],
    "Errors": ["errors"],
}
LONGEST = 140
KINDS = {"str": "text", "int": "whole number", "float": "number", "bool": "True or False", "Floats": "array", "Doubles": "array",
         "Floats | None": "array, or None", "Doubles | None": "array, or None", "str | None": "text, or None", "int | None": "whole number, or None"}
PROPERTIES = {"property", "cached_property", "functools.cached_property"}


def signature(function, name):
    """What a caller writes: without self, and without annotations, which stand in the source for editors."""
    words, given = [], function.args
    plain = [*given.posonlyargs, *given.args]
    defaults = [None] * (len(plain) - len(given.defaults)) + given.defaults
    for argument, default in zip(plain, defaults):
        if argument.arg not in ("self", "cls"):
            words.append(argument.arg + (f"={ast.unparse(default)}" if default else ""))
    if given.vararg:
        words.append("*" + given.vararg.arg)
    elif given.kwonlyargs:
        words.append("*")
    words += [argument.arg + (f"={ast.unparse(default)}" if default else "") for argument, default in zip(given.kwonlyargs, given.kw_defaults)]
    words += ["**" + given.kwarg.arg] if given.kwarg else []
    return f"{name}({', '.join(words)})"


def wrapped(text, indent=""):
    return textwrap.fill(" ".join(text.removeprefix(indent).split()), LONGEST, initial_indent=indent, subsequent_indent=" " * len(indent), break_long_words=False,
                         break_on_hyphens=False)


def paragraphs(text):
    """A docstring as Markdown: its paragraphs, and blocks that are indented, or begin like code, as they stand."""
    result = []
    for part in re.split(r"\n\s*\n", text):
        items = re.split(r"\n(?=\d+\. )", part)
        result.append(part if part.startswith("    ") else "\n".join(wrapped(item, re.match(r"(\d+\. )?", item)[0]) for item in items))
    return "\n\n".join(result)


def decorators(function):
    return {ast.unparse(decorator).split("(")[0] for decorator in function.decorator_list}


def fields_of(node, lines):
    """Attributes that are declared with a type, each with the comment behind it."""
    for item in node.body:
        if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name) and not item.target.id.startswith("_"):
            said = re.search(r"  #:? ?(.*)$", lines[item.end_lineno - 1])
            kind = KINDS.get(ast.unparse(item.annotation), ast.unparse(item.annotation))
            yield item.target.id, said[1] if said else kind if re.fullmatch(r"[\w. ]+", kind) else f"`{kind}`"


def members(node, classes, lines):
    """What a class has, and below it what it has from those of its module that it is made of."""
    found = [wrapped(f"`{name}`: {said}", "- ") for name, said in fields_of(node, lines)]
    for item in node.body:
        if not isinstance(item, ast.FunctionDef) or item.name.startswith("_") or "overload" in decorators(item):
            continue
        text = ast.get_docstring(item)
        if not text or any(word.endswith(".setter") for word in decorators(item)):
            continue
        named = item.name if decorators(item) & PROPERTIES else signature(item, item.name)
        found.append(wrapped(f"`{named}`: {re.split(chr(10) + r'{2,}', text)[0]}", "- "))
    for base in node.bases:
        if ast.unparse(base) in classes:
            found += members(classes[ast.unparse(base)], classes, lines)
    return found


def section(node, classes, lines):
    text = ast.get_docstring(node) or ""
    if isinstance(node, ast.ClassDef):
        begin = next((item for item in node.body if isinstance(item, ast.FunctionDef) and item.name == "__init__"), None)
        head, below = f"class {node.name}", "\n".join(members(node, classes, lines))
        if begin is not None and node.name == "Simulation":
            head = signature(begin, node.name)
    else:
        head, below = signature(node, node.name), ""
    written = textwrap.wrap(f"rouleau.{head}", 76, subsequent_indent=" " * 8, break_long_words=False, break_on_hyphens=False)
    call = "".join(f"    {line}\n" for line in written) + "\n" if not head.startswith("class ") else ""
    return f"\n### {node.name}\n\n{call}{paragraphs(text)}\n" + (f"\n{below}\n" if below else "")


def page(folder):
    package = ast.parse((folder / "__init__.py").read_text())
    homes = next(ast.literal_eval(item.value) for item in package.body
                 if isinstance(item, ast.Assign) and item.targets[0].id == "_HOME")
    left = set(homes)
    text = HEAD
    for title, modules in GROUPS.items():
        text += f"\n## {title}\n"
        for module in modules:
            source = (folder / f"{module}.py").read_text()
            nodes = ast.parse(source).body
            classes = {node.name: node for node in nodes if isinstance(node, ast.ClassDef)}
            for node in nodes:
                if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and homes.get(node.name) == module and node.name in left:
                    if isinstance(node, ast.FunctionDef) and "overload" in decorators(node):
                        continue
                    left.remove(node.name)
                    text += section(node, classes, source.splitlines())
    if left:
        raise SystemExit(f"scripts/docs: no page has {', '.join(sorted(left))} of the package rouleau")
    return text

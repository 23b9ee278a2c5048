"""The lists of columns in docs/output-tables.md, from the program's own table of observables (host/observe/columns.cpp)."""

import json
import re
import subprocess


def lines(columns):
    yield "| column | meaning |\n|---|---|"
    for column in columns:
        means = "; means in summary.json" if column["has_means"] else ""
        space = "in three dimensions: " if column["in_space"] else "in two dimensions: " if column["in_plane"] else ""
        space += "between openings: " if column["at_openings"] else ""
        space += "where that end has several, and likewise of the others: " if column["of_several_openings"] else ""
        space += "where cells may come or leave: " if column["of_traffic"] else ""
        space += "where forces or gravity act on cells: " if column["of_forces"] else ""
        space += "where cells act on each other: " if column["of_interactions"] else ""
        yield f"| `{column['column']}` | {space}{column['doc']}{means} |"


def page(path, program):
    said = subprocess.run([program, "columns"], capture_output=True, text=True, check=True, timeout=60).stdout
    tables = {f"{table['name']}.csv": table["columns"] for table in json.loads(said)}
    shared = [column for column in next(iter(tables.values())) if all(column in columns for columns in tables.values())]
    lists = {name: [column for column in columns if column not in shared] for name, columns in tables.items()}
    text = path.read_text()
    for name, columns in {"all tables": shared, **lists}.items():
        # Blank lines part the comments from the table for Markdown.
        written = f"<!-- columns of {name} -->\n\n" + "\n".join(lines(columns)) + "\n\n<!-- end -->"
        text, found = re.subn(f"<!-- columns of {re.escape(name)} -->.*?<!-- end -->", lambda _: written, text, flags=re.DOTALL)
        if found != 1:
            raise SystemExit(f"{path} has {found} places for the columns of {name}: <!-- columns of {name} --> to <!-- end -->")
    return text

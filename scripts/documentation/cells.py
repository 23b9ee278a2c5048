"""Cells of tables that can be read: what does not fit into one stands below the table."""

import re
import textwrap

LONGEST = 160  # characters of a cell, with links as they are shown


def shown(text):
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)


def split(text):
    """(what fits into a cell, the rest): whole sentences, or parts of the first between semicolons where it alone is too long."""
    if len(shown(text)) <= LONGEST:
        return text, ""
    for end in (r"(?<=[.])\s+(?=[A-Z`\"])", r"(?<=;)\s+"):
        parts = re.split(end, text)
        first = parts.pop(0)
        while parts and len(shown(f"{first} {parts[0]}")) <= LONGEST - len(" More below."):
            first += " " + parts.pop(0)
        if parts and len(shown(first)) <= LONGEST - len(" More below."):
            rest = " ".join(parts)
            return first.rstrip(".;") + ". More below.", rest[0].upper() + rest[1:]
    return "See below.", text


def table(heads, rows):
    """A table, and below it what did not fit into the last cells of its rows, by the name in the first."""
    lines, below = [f"| {' | '.join(heads)} |", "|" + "---|" * len(heads)], []
    for *cells, last in rows:
        last, rest = split(last)
        lines.append(f"| {' | '.join([*cells, last])} |")
        if rest:
            below.append(textwrap.fill(f"- {cells[0].strip('*')}: {rest}", 140, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False))
    return "\n".join(lines) + "\n" + ("\n" + "\n".join(below) + "\n" if below else "")

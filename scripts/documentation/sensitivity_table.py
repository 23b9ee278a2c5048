"""The table of sensitivities on a page: a row for each parameter, a column for each quantity, numbers that come one by one."""
import math

HEADING, FIRST, MISSING = "## Sensitivities", "as it is", "-"


def shown(value, error=math.nan):
    return f"{value:.4g}" + ("" if math.isnan(error) else f" +- {error:.2g}")


def cells_of(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def lines_of(page):
    """All lines of the page, and where the table below the heading begins and ends."""
    lines = page.read_text().split("\n")
    begin = next(i for i in range(lines.index(HEADING), len(lines)) if lines[i].startswith("|"))
    end = next(i for i in range(begin, len(lines)) if not lines[i].startswith("|"))
    return lines, begin, end


def add(page, parameter, columns):
    """Takes into the page's table what a parameter changes, and returns the table's lines. `columns` has for each quantity its
    value and error as it is, and the value with the parameter changed, or None where that run failed. A column that was made
    with another value as it is, by more than 1 %, begins anew: its numbers are of another cell or program."""
    lines, begin, end = lines_of(page)
    names, table = cells_of(lines[begin])[1:], {}
    for line in lines[begin + 2:end]:
        row, *cells = cells_of(line)
        table[row] = dict(zip(names, cells))
    for name, ((value, error), after) in columns.items():
        before = table[FIRST].get(name, MISSING)
        if before == MISSING or abs(float(before.split()[0]) / value - 1) > 0.01:
            for row in table.values():
                row[name] = MISSING
        names += [name] * (name not in names)
        table[FIRST][name] = shown(value, error)
        table.setdefault(parameter, {})[name] = (
            "failed" if after is None else "no turn" if math.isnan(after) else f"{100 * (after / value - 1):+.1f} %")
    made = [f"| | {' | '.join(names)} |", "|---" * (len(names) + 1) + "|"]
    made += [f"| {row} | {' | '.join(cells.get(name, MISSING) for name in names)} |" for row, cells in table.items()]
    page.write_text("\n".join([*lines[:begin], *made, *lines[end:]]))
    return made

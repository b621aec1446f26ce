"""Results as CSV and as tables in Markdown."""

import csv
import json

# How write_csv writes what JSON writes in another way.
WORDS = {"True": True, "False": False, "inf": float("inf")}


def write_csv(results, path):
    columns = list(dict.fromkeys(key for result in results for key in result))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(results)


def read_csv(path):
    """The rows that write_csv wrote, without the keys that have no value."""
    with open(path, newline="") as file:
        return [{key: value_of(cell) for key, cell in row.items() if cell} for row in csv.DictReader(file)]


def value_of(cell):
    """A number, a list or a truth value where the cell is one, otherwise its text."""
    try:
        return WORDS[cell] if cell in WORDS else json.loads(cell)
    except ValueError:
        return cell


def write_table(path, columns, rows, explanation=""):
    """Writes table() and what explains it to a file, and returns both."""
    text = table(columns, rows) + explanation
    path.write_text(text)
    return text


def table(columns, rows):
    """A line for each row. A column has a heading and a cell: a key of the row, or a function of the row."""
    return markdown([heading for heading, _ in columns],
                    [[row[cell] if isinstance(cell, str) else cell(row) for _, cell in columns] for row in rows])


def markdown(header, rows):
    lines = ["| " + " | ".join(str(cell) for cell in row) + " |" for row in [header, *rows]]
    lines.insert(1, "|---" * len(header) + "|")
    return "\n".join(lines) + "\n"


def shown(key, form):
    """A cell: the value of the key in this format of str.format()."""
    return lambda row: form.format(row[key])


def rounded(key):
    """A cell: the value of the key with its significant digits."""
    return lambda row: significant(row[key])


def spaced(*keys):
    """Columns whose headings are their keys, with spaces."""
    return [(key.replace("_", " "), key) for key in keys]


def significant(value):
    """Two digits of small numbers, all digits of large ones."""
    return f"{value:.2g}" if value < 99.5 else f"{value:.0f}"


def scene_title(row):
    return row["scene"] if row["scale"] == 1.0 else f"{row['scene']} ×{row['scale']:g}"

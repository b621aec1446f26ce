"""Results as CSV and as tables in Markdown."""

import csv


def write_csv(results, path):
    columns = list(dict.fromkeys(key for result in results for key in result))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(results)


def markdown(header, rows):
    lines = ["| " + " | ".join(str(cell) for cell in row) + " |" for row in [header, *rows]]
    lines.insert(1, "|---" * len(header) + "|")
    return "\n".join(lines) + "\n"


def significant(value):
    """Two digits of small numbers, all digits of large ones."""
    return f"{value:.2g}" if value < 99.5 else f"{value:.0f}"

"""Curves of a page's block, as docs/report_json.md has them: every column as a list of numbers."""
import base64
import math
import struct


def numbers(column):
    packed = base64.b64decode(column)
    values = (struct.unpack("<d", bytes(3) + packed[i:i + 5])[0] for i in range(0, len(packed), 5))
    return [None if math.isnan(value) else value for value in values]


def unpacked(curves):
    difference = {name: numbers(column) for name, column in curves["difference"].items()}
    tables = []
    for table in curves["tables"]:
        columns = {}
        for name, column in table["columns"].items():
            if column is True:  # the first table's, with what the second differs by
                first = tables[0]["columns"][name]
                by = difference.get(name) or [0] * len(first)
                columns[name] = [None if v is None else v + (d or 0) for v, d in zip(first, by)]
            else:
                columns[name] = numbers(column)
        tables.append({"name": table["name"], "columns": columns})
    return {**curves, "tables": tables, "difference": difference}

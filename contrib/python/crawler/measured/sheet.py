# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables as text, written by instruments, trackers and spreadsheets: the cells, and their meaning as numbers."""
import csv
import dataclasses
import datetime
import re
import statistics

import numpy as np

from ..needs import InputError
from .units import split_unit

GAPS = {"", "nan", "na", "n/a", "-", "--", "null", "none"}
COMMENTS = ("#", "%", "//")
ERROR = re.compile(r"#(N/?[A-Z]|[^\s;,]*[!?])(?=[;,\t]|$)")  # of a spreadsheet: #N/A, #DIV/0!, in any language
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
DECIMAL_COMMA = re.compile(r"[+-]?(\d*,\d+|\d+,)([eE][+-]?\d+)?")
GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")  # 1,000: a thousand, or a number with three decimals
GROUPED_BY_POINTS = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+(,\d*)?")
CLOCK = re.compile(r"\d+:\d\d:\d\d([.,]\d*)?|\d{4}-\d\d-\d\d[T ].*")
SEPARATORS = {";": "semicolons", "\t": "tabs", ",": "commas", " ": "blanks"}
FOREIGN = ((b"\xff\xfe", "text in UTF-16"), (b"\xfe\xff", "text in UTF-16"), (b"PK\x03\x04", "a workbook or an archive (zip)"),
           (b"\x1f\x8b", "compressed (gzip)"), (b"\xd0\xcf\x11\xe0", "a workbook (xls)"))


def is_gap(cell):
    """Returns True if nothing was measured."""
    return cell.lower() in GAPS


@dataclasses.dataclass
class Sheet:
    """Cells of a file as text: rows of names (head) above rows of samples, all with the same number of columns.

    Cells are converted to numbers at their use, so that unused columns may contain anything.
    """
    name: str     # name of the file, for messages
    head: list    # [row][column], may be empty
    rows: list    # [row][column]
    lines: list   # line number of each row in the file, from 1
    comma: str    # meaning of a comma in a number: "decimal", "thousands" or "" (none)
    words: list   # findings, for the report
    notes: list   # reports of a different order

    @property
    def names(self):
        """Names of the columns, from the first row of the head, without units."""
        return [split_unit(cell)[0] for cell in self.head[0]] if self.head else []

    @property
    def units(self):
        """Units of the columns, behind the names or in a row of their own; missing ones are empty."""
        units = [split_unit(cell)[1] for cell in self.head[0]] if self.head else []
        for row in self.head[1:]:
            is_units = len(self.head) == 2 or all(cell[:1] in ("", "(", "[") for cell in row)
            units = [unit or (cell.strip("()[]") if is_units else "") for unit, cell in zip(units, row)]
        return units

    def label(self, column):
        """Name of a column, for messages; of all rows of the head if the first one has the same name for many."""
        names = self.names
        if len(self.head) > 1 and names.count(names[column]) > 2:
            return " ".join(row[column] for row in self.head[1:])
        return (names[column] if self.head else "") or f"column {column + 1}"

    def number(self, cell):
        """Number in a cell; NaN for a gap, None for anything else."""
        cell = cell.replace("\N{MINUS SIGN}", "-")
        if is_gap(cell):
            return np.nan
        if self.comma == "decimal":
            if GROUPED_BY_POINTS.fullmatch(cell):
                cell = cell.replace(".", "")  # 1.234,5 and 1.234
            elif "." in cell:
                return None
            cell = cell.replace(",", ".")
        elif self.comma == "thousands" and GROUPED.fullmatch(cell.split(".")[0]):
            cell = cell.replace(",", "")
        return float(cell) if NUMBER.fullmatch(cell) else None

    def column(self, i):
        """Numbers of a column, array [row] with NaN for gaps. Raises InputError that names the first other cell."""
        cells = [row[i] for row in self.rows]
        if not self.comma and not any("_" in cell for cell in cells):
            try:
                numbers = np.array(cells, dtype=float)
                if not np.any(np.isinf(numbers)):
                    return numbers
            except ValueError:
                pass  # gaps in words, or a cell that is no number
        numbers = [self.number(cell) for cell in cells]
        wrong = [r for r, number in enumerate(numbers) if number is None]
        if wrong:
            raise InputError(self.wrong_cell(self.lines[wrong[0]], cells[wrong[0]], i, len(wrong)))
        return np.array(numbers)

    def times(self, i):
        """Numbers, or the seconds since the first of clock times (ISO 8601 or h:m:s), array [row]."""
        cells = [row[i] for row in self.rows]
        try:
            if all(re.fullmatch(r"\d+:\d\d:\d\d([.,]\d*)?", cell) for cell in cells):
                clock = np.array([np.dot([3600, 60, 1], [float(part) for part in cell.replace(",", ".").split(":")]) for cell in cells])
                clock[1:] += 86400 * np.cumsum(np.diff(clock) < -43200)  # midnight
            elif all(re.match(r"\d{4}-\d\d-\d\d[T ]", cell) for cell in cells):
                dates = [datetime.datetime.fromisoformat(cell.replace("Z", "+00:00")) for cell in cells]
                clock = [(date - dates[0]).total_seconds() for date in dates]
            else:
                return self.column(i)
        except (TypeError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(f'"{self.label(i)}" of "{self.name}" has invalid clock times: {error}') from None
        self.words.append(f'"{self.label(i)}" are clock times; t is in seconds from {cells[0]} on')
        return np.round(np.array(clock) - clock[0], 9)

    def wrong_cell(self, line, cell, i, n_more=1):
        """Error message about a cell that is no number."""
        more = f" (and {n_more - 1} more {'row has' if n_more == 2 else 'rows have'} no number there)" if n_more > 1 else ""
        return (f'row {line} of "{self.name}" has "{cell}" under {self.label(i)}, but a number'
                f'{" with a decimal comma" if self.comma == "decimal" else ""} (or nothing or NaN for a gap) is expected{more}')


def text_of(data, name):
    """Text of a file. Raises InputError that says what it is instead."""
    for magic, kind in FOREIGN:
        if data.startswith(magic):
            raise InputError(f'"{name}" is {kind}, but a table as text in UTF-8 is expected')
    if b"\0" in data[:4096]:
        raise InputError(f'"{name}" is a binary file, but a table as text in UTF-8 is expected')
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")  # units like µm of older programs


def cells_of(line, separator):
    """Cells of a line, without blanks and quotes around them."""
    if separator == " ":
        parts = line.split()
    else:
        parts = next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    return [part.strip().strip("'\"").strip() for part in parts]


def separator_of(line):
    """Separator: the first of semicolon, tab and comma in a line, else blanks."""
    for separator in (";", "\t"):
        if separator in line:
            return separator
    parts = line.split()
    # Blanks may separate numbers with decimal commas: "0,5 1,25".
    if "," not in line or (len(parts) > 1 and all(DECIMAL_COMMA.fullmatch(part) or NUMBER.fullmatch(part) or is_gap(part)
                                                  for part in parts)):
        return " "
    return ","


def meaning_of_commas(rows, separator, name, decimal):
    """Returns whether commas in numbers stand before decimals or group thousands ("1,000"); @p decimal, "comma" or
    "point", decides if it is given. Raises InputError if both are possible, also where all points may group thousands
    between semicolons, as programs write them where decimals have commas."""
    if decimal not in ("", "comma", "point"):
        raise InputError(f'"--decimal" is "{decimal}", but "comma" or "point" is expected')
    if decimal == "comma" and separator == "," and not any(DECIMAL_COMMA.fullmatch(cell) for row in rows for cell in row):
        raise InputError(f'"--decimal" is "comma", but in "{name}" commas separate the columns; semicolons or tabs between them are expected')
    if decimal:
        return "decimal" if decimal == "comma" else "thousands"
    numbers = [cell for row in rows for cell in row if re.fullmatch(r"[+-]?\d[\d.,]*", cell)]
    points = [cell for cell in numbers if "." in cell]
    if separator == ";" and points and all(GROUPED_BY_POINTS.fullmatch(cell) for cell in points):
        if any("," in cell for cell in numbers):
            return "decimal"
        _refuse_either(points[0], points[0], points[0].replace(".", ""), name)
    cells = [cell for row in rows for cell in row if "," in cell]
    decimal = [cell for cell in cells if DECIMAL_COMMA.fullmatch(cell) and not GROUPED.fullmatch(cell)]
    grouped = [cell for cell in cells if GROUPED.fullmatch(cell.split(".")[0]) and (cell.count(",") > 1 or "." in cell)]
    either = [cell for cell in cells if GROUPED.fullmatch(cell) and cell.count(",") == 1]
    if decimal and grouped:
        raise InputError(f'"{name}" has "{decimal[0]}" and "{grouped[0]}", but commas of one meaning are expected: decimals '
                         "or thousands")
    if decimal or grouped or not either:
        return "decimal" if decimal else "thousands" if grouped else ""
    if separator == ",":
        return "thousands"
    column = [row[0] for row in rows]
    readings = {}
    for meaning in ("decimal", "thousands"):
        values = [float(cell.replace(",", "." if meaning == "decimal" else "")) if NUMBER.fullmatch(cell.replace(",", "")) else
                  np.nan for cell in column]
        readings[meaning] = np.all(np.diff(values) > 0)
    if readings["thousands"] and not readings["decimal"]:
        return "thousands"
    if readings["decimal"] and not readings["thousands"]:
        return "decimal"
    _refuse_either(either[0], either[0].replace(",", "."), either[0].replace(",", ""), name)


def _refuse_either(cell, one, other, name):
    raise InputError(f'"{name}" has "{cell}", which may be {one} or {other}; "--decimal comma" or "--decimal point" says which')


def read_sheet(data, name, decimal=""):
    """Reads the Sheet of the bytes of a file: columns between semicolons, tabs, commas or blanks; decimals with a point
    or, unless commas separate the columns, a comma; comments that begin with #, % or //; titles above the names. Raises
    InputError with the number of the line."""
    lines, comment, forced = [], "", None
    for number, line in enumerate(text_of(data, name).splitlines(), 1):
        shown = line.strip()
        if not shown.strip(';,"\t'):  # spreadsheets write rows of empty cells below a table
            continue
        if not lines and (match := re.fullmatch(r'"?sep=(.)"?', shown)):
            forced = match[1]  # Excel
        elif not shown.startswith(COMMENTS) or ERROR.match(shown):
            lines.append((number, line))
        elif not lines:
            comment = shown.lstrip("#%/ ")
    if not lines:
        raise InputError(f'"{name}" is empty, but a table of numbers is expected')
    tail = lines[-min(20, max(1, len(lines) // 2)):]  # one of them may be cut off, or a remark
    separator = forced or statistics.mode(separator_of(line) for _, line in tail)
    rows = [(number, cells_of(line, separator)) for number, line in lines]
    widths = [len(cells) for _, cells in rows]
    width = max(widths[::-1], key=widths.count)  # a title, or a last row that was cut off, has another one
    whole = [cells for _, cells in rows if len(cells) == width]
    sheet = Sheet(name, [], [], [], meaning_of_commas(whole[1:] or whole, separator, name, decimal), [], [])

    # Columns of numbers are those of the last rows; samples begin where all of them have numbers.
    last = whole[-min(20, max(1, len(whole) // 2)):]
    def value(cell):
        return 0.0 if CLOCK.fullmatch(cell) else sheet.number(cell)
    numeric = [i for i in range(width) if sum(value(cells[i]) is not None for cells in last) > len(last) / 2]
    filled = [i for i in numeric if not all(is_gap(cells[i]) for cells in whole)]

    def is_sample(cells):
        values = [value(cells[i]) for i in numeric] if len(cells) == width else [None]
        return None not in values and not np.all(np.isnan(values))

    begin = next((r for r, (_, cells) in enumerate(rows) if is_sample(cells)), None)
    if begin is None or not filled:
        raise InputError(f'"{name}" has no row of numbers; its last line, {rows[-1][0]}, is "{lines[-1][1].strip()}"')
    _read_head(sheet, rows[:begin], width, numeric, (comment, separator))
    for number, cells in rows[begin:]:
        if len(cells) != width:
            raise InputError(f'row {number} of "{name}" has {len(cells)} cells, but {width} are expected, as in most others')
        if all(is_gap(cells[i]) for i in filled):
            raise InputError(f'row {number} of "{name}" has no number, but at least one is expected')
        sheet.rows.append(cells)
        sheet.lines.append(number)
    _drop_empty_columns(sheet, width)
    are_grouped = sheet.comma == "decimal" and any(GROUPED_BY_POINTS.fullmatch(cell) for cells in sheet.rows for cell in cells)
    decimals = {"decimal": f", with decimal commas{'; points group thousands (1.000 is a thousand)' if are_grouped else ''}",
                "thousands": "; commas group thousands (1,000 is a thousand)" if any("," in cell for cells in sheet.rows for cell in cells) else ""}
    sheet.words.insert(0, f"{len(sheet.rows)} rows of {len(sheet.rows[0])} columns between {SEPARATORS.get(separator, repr(separator))}"
                          f"{decimals.get(sheet.comma, '')}")
    return sheet


def _read_head(sheet, rows, width, numeric, comment):
    """Rows of names and units, without titles: rows with a single filled cell or other numbers of cells; if there are
    none, a comment may have the names."""
    n_titles = 0
    for number, cells in rows:
        if len(cells) != width or sum(cell != "" for cell in cells) < min(2, width):
            n_titles += 1
            continue
        # Numbers may be names (places), but not units: this is a row of samples.
        is_number = [i for i in numeric if not is_gap(cells[i]) and sheet.number(cells[i]) is not None]
        if sheet.head and is_number and cells[0].lower() not in ("bodyparts", "individuals"):
            wrong = next(i for i in numeric if sheet.number(cells[i]) is None)
            raise InputError(sheet.wrong_cell(number, cells[wrong], wrong))
        sheet.head.append(cells)
    if not sheet.head and len(cells := cells_of(*comment)) == width:
        sheet.head.append(cells)
    if n_titles:
        sheet.words.append(f"{n_titles} line{'s' if n_titles > 1 else ''} above the names left out")


def _drop_empty_columns(sheet, width):
    """Removes columns at the end that have neither name nor cell: many programs write a separator behind the last
    one."""
    keep = width
    while keep > 1 and not any(row[keep - 1] for row in sheet.head + sheet.rows):
        keep -= 1
    if keep < width:
        sheet.words.append(f"{width - keep} empty column{'s' if width - keep > 1 else ''} at the end left out")
        sheet.head = [row[:keep] for row in sheet.head]
        sheet.rows = [row[:keep] for row in sheet.rows]

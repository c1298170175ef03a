"""Which figure of a page comes from where: doc/data/figures/<page>.toml."""

import ast
import builtins
import math
import re
import tomllib
from dataclasses import dataclass
from functools import cache

import numpy

from figures.page import HOLE, Page, numbers_in, without_names
from figures.sources import Failed, NotRun, Source
from results import ROOT, read_numbers, read_rows

DATA = ROOT / "doc/data/figures"


@dataclass
class Kind:
    """A figure that is not simply to be what is printed."""

    value: float
    kind: str


def kind_of(kind):
    def wrap(*values):
        values = [Kind(float(value), kind) for value in flat(values)]
        return values[0] if len(values) == 1 else values

    return wrap


def flat(values):
    if isinstance(values, (list, tuple, numpy.ndarray)):
        return [number for value in values for number in flat(value)]
    return [values]


def curve(path):
    """The columns of a CSV file below prm/ or doc/, by name."""
    return read_numbers(next(folder / path for folder in (ROOT / "prm", ROOT)
                             if (folder / path).exists()))


FUNCTIONS = {
    # the printed figure is a bound; is round: its neighbours will do; is a time; may be
    # round-off, of which only the size below 1e-12 counts.
    "below": kind_of("below"),
    "above": kind_of("above"),
    "about": kind_of("about"),
    "seconds": kind_of("seconds"),
    "roundoff": kind_of("roundoff"),
    # what a cell has beside results, such as another's figures
    "given": Kind(math.nan, "given"),
    "percent": lambda *values: [100 * value for value in flat(values)],
    "curve": curve,
    "table": lambda path: read_rows(ROOT / path)[0],
    "flat": flat,
    "mean": lambda values: float(numpy.mean(values)),
    "ln": math.log,
    "exp": math.exp,
    "sqrt": math.sqrt,
    "pi": math.pi,
    "np": numpy,
}


def compare(number, figure, factor):
    """How a printed number stands to its recomputed figure: equal, near, differs or, for
    a time, off."""
    kind = figure.kind if isinstance(figure, Kind) else ""
    value = figure.value if kind else float(figure)
    unit = number.unit
    printed = number.value
    half = unit / 2 * (1 + 1e-9) + 1e-12 * abs(printed)
    if kind == "given":
        return "equal"
    if math.isnan(value):
        return "differs"
    if kind == "seconds":
        off = value > factor * (printed + unit / 2) or value < max(printed - unit / 2, 0) / factor
        return "off" if off else "equal"
    if kind == "roundoff" and max(abs(value), abs(printed)) < 1e-12:
        return "equal"
    if kind == "below":
        return "equal" if value <= printed + half else "differs"
    if kind == "above":
        return "equal" if value >= printed - half else "differs"
    if abs(value - printed) <= half:
        return "equal"
    near = abs(value - printed) <= 3 * half and abs(value - printed) <= 0.02 * abs(printed)
    if kind == "about":
        return "equal" if abs(value - printed) <= 3 * half else "differs"
    return "near" if near else "differs"


@dataclass
class Item:
    """Numbers that an expression recomputes."""

    numbers: list
    expression: str
    names: dict  # r and c of a cell, as expressions


class Binding:
    """What is known of the figures of one page. `problems` are those of the data."""

    def __init__(self, name):
        self.name = name
        self.page = Page(ROOT / name)
        path = DATA / (name.rsplit("/", 1)[-1].removesuffix(".md") + ".toml")
        self.problems, self.items, self.covered = [], [], {}
        self.data = {}
        if path.exists():
            with self._telling(f"{path.relative_to(ROOT)}: "):
                self.data = tomllib.loads(path.read_text(encoding="utf-8"))
        unknown = set(self.data) - {"text", "let", "sources", "table", "given"}
        self.problems += [f"{path.name}: '{key}' is not known" for key in sorted(unknown)]
        self.sources = {}
        for source, entry in self.data.get("sources", {}).items():
            with self._telling():
                self.sources[source] = Source(source, entry, self.sources)
        self.let = self.data.get("let", {})
        for excerpt in self.data.get("text", []):
            with self._telling():
                self._bind_text(excerpt)
        for entry in self.data.get("table", []):
            with self._telling(f"{entry.get('under')}, {entry.get('place', 1)}: "):
                self._bind_table(entry)
        self._bind_tests()
        for reason, excerpts in self.data.get("given", {}).items():
            for excerpt in excerpts:
                with self._telling():
                    for _, start, end in self.page.find_all(excerpt):
                        self._cover(self.page.numbers_within(start, end), reason)

    def _telling(self, where=""):
        return Telling(self, where)

    def _cover(self, numbers, by):
        for number in numbers:
            self.covered.setdefault(number.start, by)

    def _add(self, numbers, expression, names=None):
        self._names(expression, names or {})
        self.items.append(Item(numbers, expression, names or {}))
        self.covered.update((number.start, "bound") for number in numbers)

    def _bind_text(self, excerpt):
        numbers, start, end = self.page.find(excerpt)
        if not numbers:
            raise ValueError(f"without a hole: {excerpt}")
        for number, expression in zip(numbers, HOLE.split(excerpt)[1::2]):
            self._add([number], expression)
        self._cover(self.page.numbers_within(start, end), "label")

    def _bind_tests(self):
        for start, end, name in self.page.rows_of_tests():
            if not is_test(name):
                self.problems.append(f"there is no test {name}")
            self._cover(self.page.numbers_within(start, end), "by a test")

    def _bind_table(self, entry):
        unknown = set(entry) - {"under", "place", "rows", "columns", "cell", "output", "nth",
                                "seconds", "without", "each"}
        if unknown:
            raise ValueError(f"unknown: {', '.join(unknown)}")
        table = self.page.table(entry["under"], entry.get("place", 1))
        if "output" in entry:
            self._bind_output(table, entry)
            return
        if "each" in entry:
            self._bind_each(table, entry["each"])
            return
        rows = self._chosen(entry.get("rows"), [row[0][2] for row in table.rows], True)
        heads = [cell[2] for cell in table.head]
        columns = self._chosen(entry.get("columns"), heads, False)
        by_column = any("r" in names_in(e) for _, e in columns if e not in ("", "given"))
        shown = [""] * len(table.rows)
        above = []
        for k, row in enumerate(table.rows):  # labels, filled down
            texts = [cell[2] for cell in row]
            above = [text or (above[j] if j < len(above) else "") for j, text in enumerate(texts)]
            shown[k] = above
        first = min(j for j, _ in columns)
        for row in table.rows:  # what stands before is labels
            self._cover(self.page.numbers_within(row[0][0], row[first - 1][1]), "label")
        for k, r in rows:
            for j, c in columns:
                if "" in (r, c):
                    continue
                if len(table.rows[k]) <= j:
                    raise ValueError(f"row {k + 1} has no column {j + 1}")
                start, end, text = table.rows[k][j]
                numbers = self.page.numbers_within(start, end)
                if not numbers:
                    continue
                if "given" in (r, c):
                    self._cover(numbers, "given")
                    continue
                code = re.search(r"`([^`]*)`", text)
                label = repr(code[1] if code else text)
                r_filled, c_filled = (
                    fill(e, texts).replace("{row}", str(k)).replace("{column}", str(j))
                    .replace("{label}", label) for e, texts in ((r, shown[k]), (c, heads)))
                if "cell" in entry:
                    self._add(numbers, entry["cell"].replace("{label}", label),
                              {"r": r_filled, "c": c_filled})
                elif by_column:
                    self._add(numbers, c_filled, {"r": r_filled})
                else:
                    self._add(numbers, r_filled, {"c": c_filled})

    def _chosen(self, entry, labels, from_first):
        """Indices of rows or columns and what stands for them."""
        if isinstance(entry, str):
            first = 0 if from_first else 1
            return [(k, entry) for k in range(first, len(labels))]
        if isinstance(entry, list):
            if len(entry) > len(labels) - (0 if from_first else 1):
                raise ValueError(f"{len(entry)} expressions for {labels}")
            first = 0 if from_first else len(labels) - len(entry)
            return [(first + k, expression) for k, expression in enumerate(entry)]
        chosen = []
        for label, expression in (entry or {}).items():
            if labels.count(label) != 1:
                raise ValueError(f"'{label}' stands {labels.count(label)} times in {labels}")
            chosen.append((labels.index(label), expression))
        return chosen

    def _bind_output(self, table, entry):
        """A table that a command prints: rows by their order, columns by their heads."""
        source = entry["output"]
        if source not in self.sources:
            raise ValueError(f"no source '{source}'")
        for k, row in enumerate(table.rows):
            for j, (start, end, _) in enumerate(row):
                numbers = self.page.numbers_within(start, end)
                head = table.head[j][2]
                if not numbers or head in entry.get("without", []):
                    continue
                what = f'printed_cell({source}, {entry.get("nth", 1)}, {k}, {j}, {head!r})'
                if head in entry.get("seconds", []):
                    what = f"seconds({what})"
                self._add(numbers, what)

    def _bind_each(self, table, command):
        """Every row is what a command prints for the name in it, but for round-off; the last
        column has the time that this takes."""
        for row in table.rows:
            label = re.search(r"`([^`]*)`", self.page.text[row[0][0]:row[-1][1]])[1]
            source = "row_" + re.sub(r"\W", "_", label)
            time = re.fullmatch(r"([\d.]+) (s|min)", row[-1][2])
            cost = float(time[1]) * (60 if time[2] == "min" else 1) if time else None
            words = {"command": command.replace("{label}", label), "seconds": cost}
            self.sources[source] = Source(source, words, self.sources)
            for j, (start, end, _) in enumerate(row):
                numbers = self.page.numbers_within(start, end)
                if numbers:
                    kind = "seconds" if j == len(row) - 1 else "roundoff"
                    head = table.head[j][2]
                    self._add(numbers, f"{kind}(printed_cell({source}, 1, 0, {j}, {head!r}))")

    # Evaluation

    def _names(self, expression, names):
        """All that an expression needs, through `let` and the names of a cell."""
        found = set()
        waiting = [expression]
        while waiting:
            for name in names_in(waiting.pop()):
                if name in found:
                    continue
                found.add(name)
                if name in names:
                    waiting.append(names[name])
                elif name in self.let:
                    waiting.append(self.let[name])
                elif not (name in self.sources or name in FUNCTIONS or hasattr(builtins, name)
                          or name == "printed_cell"):
                    raise ValueError(f"nothing is called '{name}': {expression}")
        return found

    def needed(self, item):
        return [self.sources[name] for name in sorted(self._names(item.expression, item.names))
                if name in self.sources]

    def evaluate(self, item):
        """One figure for each number of an item."""
        space = dict(FUNCTIONS, printed_cell=printed_cell)
        for source in self.needed(item):
            space[source.name] = source.result
        needed = self._names(item.expression, item.names)

        def define(name, expression):
            for other in names_in(expression):
                if other in self.let and other not in space:
                    define(other, self.let[other])
            space[name] = eval(expression, space)  # data of this repository

        try:
            for name in needed & set(self.let):
                if name not in space:
                    define(name, self.let[name])
            for name, expression in item.names.items():
                if expression:
                    define(name, expression)
            figures = flat(eval(item.expression, space))
        except (NotRun, Failed):
            raise
        except Exception as error:
            raise Failed(f"{item.expression}: {type(error).__name__}: {error}") from error
        if len(figures) != len(item.numbers):
            raise Failed(f"{item.expression}: {len(figures)} figures for "
                         f"{', '.join(n.text for n in item.numbers)}")
        return figures


class Telling:
    """Keeps what is wrong in the data, so that the rest is read, too."""

    def __init__(self, binding, where):
        self.binding, self.where = binding, where

    def __enter__(self):
        return self

    def __exit__(self, kind, error, _):
        if kind and issubclass(kind, (ValueError, KeyError, SyntaxError)):
            self.binding.problems.append(f"{self.where}{error}")
            return True
        return False


def names_in(expression):
    """Names that are used and not bound within."""
    tree = ast.parse(expression, mode="eval")
    inner = {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)}
    inner |= {node.id for node in ast.walk(tree)
              if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    return {node.id for node in ast.walk(tree)
            if isinstance(node, ast.Name) and node.id not in inner}


def fill(expression, labels):
    """{0} is the first label, and so on."""
    return re.sub(r"\{(\d)\}", lambda m: repr(labels[int(m[1])]), expression)


def printed_cell(output, nth, row, column, head):
    """Numbers in a cell of a table in what a command printed."""
    tables, table = [], []
    for line in output.text.splitlines() + [""]:
        if line.startswith("|"):
            table.append([cell.strip() for cell in line.strip().strip("|").split("|")])
        elif table:
            tables.append(table)
            table = []
    table = tables[nth - 1]
    names = table[0]
    place = names.index(head) if names.count(head) == 1 else column
    text = table[2 + row][place]
    return [number.value for number in numbers_in(without_names(text))]


@cache
def tests():
    """Names of all unit tests."""
    texts = (path.read_text(encoding="utf-8") for path in (ROOT / "tests/unit").rglob("*_test.cc"))
    pattern = re.compile(r"^\s*(?:TYPED_)?TEST(?:_[PF])?\(\s*(\w+),\s*(\w+)", re.M)
    return [".".join(name) for text in texts for name in pattern.findall(text)]


def is_test(name):
    pattern = re.compile(re.escape(name).replace(r"\*", ".*"))
    return any(pattern.fullmatch(test) for test in tests())

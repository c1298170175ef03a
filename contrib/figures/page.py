"""A page of Markdown: its numbers, its tables, and where an excerpt stands in it."""

import bisect
import math
import re
from dataclasses import dataclass, field

DIGITS = r"(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:[eE][-+]?\d+)?"
# Not part of a name (Q1, T_0, 3D), of a section (3.1.2) or of a power.
NUMBER = re.compile(rf"(?:(?<![\w.^/])(?<!\w-)[-+]?|(?<=\d-)){DIGITS}(?![\w^]|\.\d)")
HOLE = re.compile(r"\{([^{}]*)\}")
TEST = re.compile(r"`([A-Z]\w+\.[\w*]+)`")

# What holds no figures: code, formulas, headings, pictures, targets of links, where
# something was published, years.
NO_FIGURES = (
    re.compile(r"^```.*?^```$", re.M | re.S),
    re.compile(r"(?<=\n\n)(?: {4,}[^\n]*\n+)+"),
    re.compile(r"`[^`]*`"),
    re.compile(r"^#.*$", re.M),
    re.compile(r"!\[[^\]]*\]"),
    re.compile(r"\]\([^)]*\)"),
    re.compile(r"\b\d+(?:, no\. \d+)? \((?:18|19|20)\d\d\)(?:,? \d+(?:-\d+)?)?"),
    re.compile(r"(?<![\w.])(?:1[89]\d\d|20[0-4]\d)\b(?!\.\d| ?%)"),
    re.compile(r"\b(?:[Ss]ections?|sec\.|eqs?\.|[Ff]igures?|[Tt]ables?|chapter|rows?) \d+(?:\.\d+)*"
               r"(?:(?:,| and| to) \d+(?:\.\d+)*)*[a-d]?\b"),
)
# Words rather than figures, in running text and without a unit.
SMALL = re.compile(r"[-+]?\d(?!\s?(?:%|[kMGmcµu]?(?:m|s|N|J|Pa|B|K|g)\b|times|degrees|-fold))")
# Tables of entries and their ranges have no results.
NO_RESULTS = {"entry", "range", "unit", "source", "`Law`", "criterion", "Kind"}


@dataclass(frozen=True)
class Number:
    """As it is printed: `unit` is one in its last digit."""

    start: int
    end: int
    text: str

    @property
    def value(self):
        return float(self.text.replace(",", ""))

    @property
    def unit(self):
        mantissa, _, exponent = self.text.lower().partition("e")
        return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))

    def printed_like_it(self, value, digits=0):
        """Another value, to as many decimals, or more if it has fewer digits than that."""
        mantissa, power, _ = self.text.lower().partition("e")
        decimals = len(mantissa.partition(".")[2])
        if power:
            mantissa, _, exponent = f"{value:.{decimals}e}".partition("e")
            return f"{mantissa}e{int(exponent)}"
        if digits and value:
            decimals = max(decimals, digits - 1 - math.floor(math.log10(abs(value))))
        plus = "+" if self.text.startswith("+") else ""
        text = f"{value:{plus}{',' if ',' in self.text else ''}.{decimals}f}"
        return text if float(text.replace(",", "")) else text.lstrip("+-")


def without_names(text):
    """Blanks where there are no figures."""
    for pattern in NO_FIGURES:
        text = pattern.sub(lambda m: re.sub(r"\S", " ", m[0]), text)
    return text


def numbers_in(text):
    return [Number(m.start(), m.end(), m[0]) for m in NUMBER.finditer(text)]


@dataclass
class Table:
    heading: str
    place: int  # 1: the first one below this heading
    start: int
    head: list
    rows: list = field(default_factory=list)  # of cells (start, end, text)


class Page:
    def __init__(self, path):
        self.text = path.read_text(encoding="utf-8")
        self.lines = [m.start() for m in re.finditer("^", self.text, re.M)]
        blanked = without_names(self.text)
        self.tables = list(self._read_tables())
        tables = [(table.start, table.rows[-1][-1][1] if table.rows else table.start)
                  for table in self.tables]
        labels = [(start, end) for table in self.tables
                  for start, end, _ in table.head + [row[0] for row in table.rows
                                                     if not self._says_by_what(row)]]
        labels += [place for table, place in zip(self.tables, tables)
                   if NO_RESULTS & {cell[2] for cell in table.head}]

        def within(places, number):
            return any(start <= number.start < end for start, end in places)

        self.numbers = [
            number for number in numbers_in(blanked)
            if not within(labels, number) and (
                within(tables, number) or len(number.text.lstrip("+-")) > 1
                or not SMALL.match(blanked, number.start))
        ]

    def line(self, position):
        return bisect.bisect_right(self.lines, position)

    def numbers_within(self, start, end):
        return [n for n in self.numbers if start <= n.start and n.end <= end]

    def find(self, excerpt):
        """The numbers in its holes, its start and its end, on the page just once."""
        found = self.find_all(excerpt)
        if len(found) != 1:
            raise ValueError(f"stands {len(found)} times on the page: {excerpt}")
        return found[0]

    def find_all(self, excerpt):
        """White space is as wide as it likes. Raises ValueError if there is none."""
        parts = HOLE.split(excerpt)
        pattern = ""
        for k, part in enumerate(parts):
            if k % 2:
                pattern += rf"([-+]?{DIGITS})"
                continue
            pattern += r"\s+".join(re.escape(word) for word in re.split(r"\s+", part))
        if parts[0] == "":
            pattern = r"(?<![\w.])" + pattern
        if parts[-1] == "":
            pattern += r"(?![\w]|\.\d)"
        found = [([Number(match.start(g), match.end(g), match[g])
                   for g in range(1, (match.lastindex or 0) + 1)], match.start(), match.end())
                 for match in re.finditer(pattern, self.text)]
        if not found:
            raise ValueError(f"does not stand on the page: {excerpt}")
        return found

    def table(self, heading, place):
        for table in self.tables:
            if table.heading == heading and table.place == place:
                return table
        raise ValueError(f"no table {place} below the heading '{heading}'")

    def rows_of_tests(self):
        """Rows that name a test, which is their source: start, end, name."""
        for table in self.tables:
            for row in table.rows:
                for name in TEST.findall(self.text[row[0][0]:row[-1][1]]):
                    yield row[0][0], row[-1][1], name

    def _read_tables(self):
        heading, place, table, in_code = "", 0, None, False
        position = 0
        for line in self.text.splitlines(keepends=True):
            stripped = line.strip()
            in_code ^= stripped.startswith("```")
            if stripped.startswith("|") and not in_code:
                cells = self._cells(line, position)
                if table is None:
                    place += 1
                    table = Table(heading, place, position, cells)
                elif not re.fullmatch(r"\|(?:\s*:?-+:?\s*\|)+", stripped):
                    table.rows.append(cells)
            else:
                if table is not None:
                    yield table
                table = None
                if line.startswith("#") and not in_code:
                    heading, place = line.strip("# \n"), 0
            position += len(line)
        if table is not None:
            yield table

    def _says_by_what(self, row):
        """Then its first cell is a result, not a label."""
        text = self.text[row[0][1]:row[-1][1]]
        return TEST.search(text) or ".prm`" in text

    @staticmethod
    def _cells(line, position):
        bars = [m.start() for m in re.finditer(r"(?<!\\)\|", line)]
        return [(position + a + 1, position + b, line[a + 1:b].strip().replace("**", ""))
                for a, b in zip(bars, bars[1:])]

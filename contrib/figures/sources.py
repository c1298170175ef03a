"""What figures are recomputed from: studies, scenes and commands, run when asked for.

Everything that a source leaves is in output/figures/<name>: `results`, what it printed, and
`run.json` once it has gone to its end, so that it is not run again by the same program."""

import hashlib
import json
import re
import shutil
import subprocess
import sys
import time
from functools import cache, cached_property
from pathlib import Path

import results
from results import PROGRAM, ROOT

import numpy

KINDS = ("study", "scene", "command")
ENTRIES = {*KINDS, "set", "ranks", "seconds"}


class NotRun(Exception):
    """A source that takes longer than was allowed."""


class Failed(Exception):
    """A source or an expression that gives no figure."""


class Names(dict):
    """Of which a name may be asked for like an attribute."""

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise Failed(f"no '{name}' among {', '.join(self)}") from None


class Run:
    """One run of the program, by what it left in a directory."""

    def __init__(self, directory, exit_code=0, status="", seconds=None):
        self.directory, self.exit_code = directory, exit_code
        self._status, self._seconds = status, seconds

    @cached_property
    def summary(self):
        try:
            return Names(results.read_json(self.directory / "summary.json"))
        except OSError:
            raise Failed(f"{self.directory.name}: {self._status or 'no summary.json'}") from None

    @cached_property
    def history(self):
        return Names(results.history(self.directory))

    @property
    def figure(self):
        return Names(self.summary["figures"])

    @property
    def error(self):
        errors = Names()
        for record in self.summary["errors"]:
            name = record["name"]
            errors[name if name not in errors else f"{name}_{record['norm']}"] = record["error"]
        return errors

    @property
    def reference(self):
        return Names({record["name"]: record["reference"] for record in self.summary["errors"]})

    @property
    def value(self):
        """What is compared with a reference."""
        return Names({record["name"]: record["value"] for record in self.summary["errors"]})

    @property
    def status(self):
        return self._status or self.summary["status"]

    @property
    def seconds(self):
        return self._seconds or self.summary["wall_seconds"]

    @property
    def phases(self):
        return Names(self.summary["wall_seconds_by_phase"])

    newton = property(lambda self: self.summary["newton_iterations"])
    krylov = property(lambda self: self.summary["linear_iterations"])
    cuts = property(lambda self: self.summary["step_cuts"])
    newton_a_step = property(lambda self: self.newton / self.steps)
    krylov_a_solve = property(lambda self: self.krylov / self.newton)

    def __getattr__(self, name):
        return getattr(self.summary, name)

    def at(self, column, where, along="time"):
        """A column of the history, linear in another."""
        x, y = self.history[along], self.history[column]
        if not x[0] <= where * (1 + 1e-9) or where * (1 - 1e-9) > x[-1]:
            raise Failed(f"{self.directory.name} has no {along} of {where}")
        return numpy.interp(where, x, y)

    def off(self, column, reference, along, start=-numpy.inf, end=numpy.inf):
        """How far a column is off that of a file in prm/, or of another run, relative, from
        a place on: at worst, and in L2. As contrib/compare_curves.py has it."""
        known = (reference.history if isinstance(reference, Run)
                 else results.read_numbers(ROOT / "prm" / reference))
        x = self.history[along]
        counts = (x >= max(start, known[along][0]) * (1 - 1e-9)) & (
            x <= min(end, known[along][-1]) * (1 + 1e-9))
        exact = numpy.interp(x, known[along], known[column])[counts]
        difference, x = self.history[column][counts] - exact, x[counts]
        return (numpy.max(numpy.abs(difference / exact)),
                numpy.sqrt(numpy.trapz(difference**2, x) / numpy.trapz(exact**2, x)))


class Study(results.Study):
    def __init__(self, directory):
        super().__init__(directory)
        self.runs = [Run(self.directory / self.name_of(row), int(row["exit_code"]), row["status"],
                         float(row["wall_seconds"] or "nan")) for row in self.rows]

    def run(self, name):
        """By the name of its directory."""
        for run in self.runs:
            if run.directory.name == name:
                return run
        raise Failed(f"no run of {self.directory.parent.name} is in {name}")

    def all(self, *labels):
        """The runs with these labels, in the order of the study."""
        return [run for run, row in zip(self.runs, self.rows)
                if all(str(label) in [row[name] for name in self.lists] for label in labels)]

    def __getitem__(self, labels):
        """The run with these labels, one for each list, or as many as it takes."""
        labels = labels if isinstance(labels, tuple) else (labels,)
        labels = [str(label) for label in labels]
        if len(labels) == len(self.lists):
            runs = [run for run, row in zip(self.runs, self.rows)
                    if [row[name] for name in self.lists] == labels]
            if runs:
                return runs[0]
        runs = self.all(*labels)
        if len(runs) != 1:
            raise Failed(f"{len(runs)} runs of {self.directory.parent.name} are called "
                         + ", ".join(labels))
        return runs[0]


class Output:
    """What a command printed."""

    def __init__(self, directory):
        self.directory = directory
        self.text = (directory / "log.txt").read_text(encoding="utf-8")

    def run(self, path=""):
        """One that the command made, by its directory: by default its own."""
        return Run(ROOT / path if path else self.directory / "results")

    def find(self, pattern):
        """The numbers in the groups of a regular expression."""
        match = re.search(pattern, self.text, re.M | re.S)
        if not match:
            raise Failed(f"nothing printed matches {pattern}")
        numbers = [float(group) for group in match.groups()]
        return numbers[0] if len(numbers) == 1 else numbers


@cache
def program_key():
    """Changes with the program, so that results do not outlive it."""
    return hashlib.sha1(PROGRAM.read_bytes()).hexdigest()


class Source:
    """Runs at most once. What takes longer than `limit` (s) does not run; with `keep` the
    results of another program are taken, too."""

    limit, keep = None, False

    def __init__(self, name, entry, others):
        self.name, self.entry, self.others = name, entry, others
        self._known = self._failure = None
        kinds = [kind for kind in KINDS if kind in entry]
        unknown = set(entry) - ENTRIES
        if len(kinds) != 1 or unknown:
            raise ValueError(f"source '{name}': one of {', '.join(KINDS)}, and "
                             f"{', '.join(sorted(ENTRIES - set(KINDS)))}; found "
                             f"{', '.join(entry)}")
        self.kind = kinds[0]
        self.seconds = entry.get("seconds")
        words = entry[self.kind]
        self.file = words if self.kind != "command" else words.split()[0]
        folder = ROOT if self.kind == "command" or self.file.startswith("tests/") else ROOT / "prm"
        self.path = folder / self.file
        if "/" in self.file and not self.path.exists():
            raise ValueError(f"source '{name}': there is no {self.path.relative_to(ROOT)}")

    @cached_property
    def needs(self):
        """Sources whose results this one reads."""
        texts = [self.entry.get("command", ""), *self.entry.get("set", [])]
        return [self.others[name] for text in texts for name in re.findall(r"\{(\w+)\}", text)]

    @property
    def cost(self):
        return (self.seconds or 0) + sum(source.cost for source in self.needs)

    @property
    def shown(self):
        """The command as one would type it."""
        return self._filled(self.line).replace(f"{ROOT}/", "")

    @cached_property
    def line(self):
        """The same with the names of other sources, which it goes by."""
        if self.kind == "command":
            return self.entry["command"]
        ranks = self.entry.get("ranks", 1)
        words = [f"mpirun -np {ranks} "] if ranks > 1 else []
        words.append("build/release/impm_dealii ")
        words.append("--study " if self.kind == "study" else "")
        words.append(str(self.path.relative_to(ROOT)))
        words += [f" --set {json.dumps(value)}" for value in self.entry.get("set", [])]
        return "".join(words)

    @cached_property
    def directory(self):
        """Named by its command and those of the sources that it reads."""
        line = re.sub(r"\{(\w+)\}", lambda m: self.others[m[1]].directory.name, self.line)
        key = hashlib.sha1(line.encode()).hexdigest()[:6]
        return ROOT / "output/figures" / f"{Path(self.file).stem}-{key}"

    @property
    def result(self):
        """Of a run that is made now, or was made before. One that failed is not tried again."""
        if self._failure:
            raise self._failure
        if self._known is None:
            try:
                self._known = self._result()
            except (Failed, NotRun) as failure:
                self._failure = failure
                raise
        return self._known

    def _filled(self, text):
        """With the directories of other sources, and its own for {}."""
        return re.sub(r"\{(\w*)\}", lambda m: str(
            (self.others[m[1]] if m[1] else self).directory / "results"), text)

    def _words(self):
        if self.kind == "command":
            return ["/bin/bash", "-c", self._filled(self.entry["command"])]
        ranks = self.entry.get("ranks", 1)
        words = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
        words += [str(PROGRAM), str(self.path), "--output", str(self.directory / "results")]
        words.append("--study" if self.kind == "study" else "--quiet")
        for value in self.entry.get("set", []):
            words += ["--set", self._filled(value)]
        return words

    def _result(self):
        for source in self.needs:
            source.result  # runs it
        done = self.directory / "run.json"
        stamp = self.directory / "program"
        known = stamp.read_text() if stamp.exists() else ""
        if not (done.exists() and (self.keep or known == program_key())):
            if self.limit is not None and not self.cost <= self.limit:
                raise NotRun(f"{self.shown}: {self.cost:g} s")
            if known != program_key():
                shutil.rmtree(self.directory, ignore_errors=True)
            (self.directory / "results").mkdir(parents=True, exist_ok=True)
            stamp.write_text(program_key())
            print(f"  runs {self.shown}", file=sys.stderr, flush=True)
            start = time.monotonic()
            with open(self.directory / "log.txt", "w", encoding="utf-8") as log, \
                 open(self.directory / "errors.txt", "w", encoding="utf-8") as errors:
                code = subprocess.run(self._words(), cwd=ROOT, stdout=log, stderr=errors,
                                      stdin=subprocess.DEVNULL, check=False).returncode
            seconds = time.monotonic() - start
            if code < 0 or code >= 128:
                raise Failed(f"{self.shown}: killed")
            done.write_text(json.dumps({"command": self.shown, "exit_code": code,
                                        "seconds": round(seconds, 2)}) + "\n")
            print(f"    exit code {code}, {seconds:.1f} s", file=sys.stderr, flush=True)
        code = json.loads(done.read_text())["exit_code"]
        results = self.directory / "results"
        if code and (self.kind != "scene" or code != 2):
            errors = (self.directory / "errors.txt").read_text(encoding="utf-8", errors="replace")
            last = errors.strip().splitlines()[-1:] or [f"exit code {code}"]
            raise Failed(f"{self.shown}: {last[0]}")
        if self.kind == "study":
            return Study(results)
        if self.kind == "scene":
            return Run(results, code)
        return Output(self.directory)

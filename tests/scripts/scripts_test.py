"""Tests of the scripts in contrib/: what they say to --help and to nonsense, and what they
draw of short runs. Exit code 77 where what they need is not installed."""

import argparse
import base64
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

MODULES = {"report.html", "report_figures.py", "results.py"}  # no scripts
BY_OTHERS = {"paraview_upsetting.py"}  # run by another program
FIELD = "equivalent_plastic_strain"


def run(*words, **options):
    words = [str(word) for word in words]
    result = subprocess.run(words, capture_output=True, text=True, timeout=100, **options)
    if "install Debian's" in result.stderr:
        skip(result.stderr.strip())
    return result


def skip(why):
    print(f"skipped: {why}")
    sys.stdout.flush()
    os._exit(77)  # from a thread, too


def call(name, *words):
    """The output of a script of contrib/ that is to succeed."""
    result = run(options.contrib / name, *words)
    assert result.returncode == 0, (name, words, result.stdout, result.stderr)
    return result.stdout


def program(code, *words):
    result = run(options.program, *words, "--quiet")
    assert result.returncode == code, result.stderr


def help():
    """Every script says what it does."""

    def check(path):
        by = [sys.executable, "-B"] if path.name in BY_OTHERS else []
        result = run(*by, path, "--help")
        said = result.returncode == 0 and len(result.stdout.split()) > 8 and not result.stderr
        return None if said else (path.name, result.returncode, result.stdout, result.stderr)

    scripts = sorted(p for p in options.contrib.iterdir() if p.is_file() and p.name not in MODULES)
    assert len(scripts) > 30
    with ThreadPoolExecutor(2) as pool:
        silent = [found for found in pool.map(check, scripts) if found]
    assert not silent, silent


def figures():
    """What recomputes the figures of the pages still fits them."""
    call("check_figures", "--texts")


def runs():
    """Makes the runs that the other tests look at."""
    shutil.rmtree(options.output, ignore_errors=True)
    short = ["--set", "Time/End time=0.001", "--set", "Grid/Cells=12, 8"]
    scene = options.scenes / "upsetting.prm"
    program(0, scene, *short, "--output", options.output / "upsetting")
    program(0, scene, *short, "--set", "Time/Time step=5e-4", "--output", options.output / "long_steps")
    hdf5 = ["--set", "Output/Format=hdf5", "--output", options.output / "hdf5"]
    program(0, scene, *short, *hdf5)
    fails = ["--set", "Solver/Newton iterations=2", "--set", "Time/Smallest time step=0.9"]
    program(2, scene, *fails, "--output", options.output / "failed")
    block = ["--set", "Grid/Cells=4, 4, 3", "--set", "Time/Largest number of steps=1"]
    program(0, options.scenes / "upsetting_quarter.prm", *block, "--output", options.output / "solid")
    shutil.copytree(options.output / "upsetting", options.output / "unfinished")
    (options.output / "unfinished/summary.json").unlink()
    with open(options.output / "unfinished/history.csv", "a") as file:
        file.write("6,1e-")  # killed while it wrote
    stopped = json.loads((options.output / "failed/summary.json").read_text())
    shutil.copytree(options.output / "upsetting", options.output / "stopped")
    (options.output / "stopped/summary.json").write_text(
        json.dumps(stopped | {"status": "stopped by a signal", "warnings": []}))
    study = Path(__file__).parent.parent / "scenes/studies/block.prm"
    reference = ["Names=pull", "pull/Kind=probe", "pull/Of=pull", "pull/Value=-0.1054"]
    words = [word for entry in reference for word in ("--set", f"Reference/{entry}")]
    program(0, study, "--study", *words, "--output", options.output / "study")
    # As it is found while it goes on, and before its first run has ended.
    for name, n_rows in (("begun", 2), ("bare", 0)):
        shutil.copytree(options.output / "study", options.output / name)
        for file in ("study.txt", "best.csv"):
            (options.output / name / file).unlink()
        lines = (options.output / "study/study.csv").read_text().splitlines(True)
        if n_rows == 0:
            lines[0] = lines[0].partition("peak_memory_kilobytes")[0] + "peak_memory_kilobytes\n"
        (options.output / name / "study.csv").write_text("".join(lines[:1 + n_rows]))


def refusals():
    """What cannot be done takes one line and exit code 1."""
    out = options.output
    (out / "empty").mkdir(exist_ok=True)
    (out / "broken").mkdir(exist_ok=True)
    for name in ("history.csv", "summary.json", "particles.pvd", "study.json", "study.csv"):
        (out / "broken" / name).write_bytes(b"\xff\x00<,")
    upsetting, study, png = out / "upsetting", out / "study", out / "never.png"
    calls = [
        ("report",),
        ("report", out / "nowhere"),
        ("report", out / "empty"),
        ("report", out / "broken"),
        ("report", upsetting, study),
        ("report", upsetting, "--field", "colour"),
        ("report", upsetting, "-o", out / "nowhere/report.html"),
        ("plot_history.py", "time"),
        ("plot_history.py", "time", "colour", png, upsetting),
        ("plot_history.py", "time", "mass", png, out / "broken"),
        ("plot_history.py", "time", "mass", out / "never.doc", upsetting),
        ("plot_points.py", upsetting, "colour", png),
        ("plot_points.py", out / "broken", FIELD, png),
        ("plot_study.py", upsetting),
        ("plot_study.py", out / "broken"),
        ("plot_study.py", study, "--errors", "colour"),
        ("compare_curves.py", upsetting / "history.csv", upsetting / "history.csv", "colour"),
        ("cost_table", study, "--within", "colour"),
        ("growth_table", out / "nowhere"),
        ("limits_table", out / "broken"),
        ("billet_figures", "colour", png, upsetting),
        ("disks_figures.py", out / "empty", study, out / "never"),
        ("footing_figure.py", out / "nowhere", png),
        ("hopkinson_disks.py", png),
        ("ring_figure.py", png, upsetting),
        ("sand_runout.py", out / "broken"),
        ("temperature_figure.py", out, png),
        ("plot_bar_parameters.py", study, png),
        ("plot_residuals.py", png, upsetting / "history.csv"),
        ("friction_by_calculix.py", "ring", "rough"),
        ("necking_by_calculix.py", "few"),
        ("plate_with_hole.py", "0", "3"),
        ("materials_figure.py", out / "nowhere", png),
        ("upsetting_table.py", "upsetting", "many"),
        ("count_instructions",),
    ]
    wrong = []
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda words: run(options.contrib / words[0], *words[1:]), calls))
    for words, result in zip(calls, results):
        lines = result.stderr.splitlines()
        if result.returncode != 1 or len(lines) != 1 or "Traceback" in result.stderr:
            wrong.append((words, result.returncode, result.stderr))
    assert not wrong, wrong
    assert not png.exists()


def plots():
    """What the README draws."""
    out = options.output
    call("plot_points.py", out / "upsetting", out / "long_steps", FIELD, out / "points.png")
    call("plot_points.py", out / "solid", "velocity", out / "solid.png")
    words = ["platen_displacement", "platen_load", out / "load.svg"]
    call("plot_history.py", *words, out / "upsetting", out / "failed")
    drawn = call("plot_study.py", out / "study").split()
    assert len(drawn) == 2, drawn
    for name in [out / "points.png", out / "solid.png", out / "load.svg", *drawn]:
        assert Path(name).stat().st_size > 5000, name
    assert "| coarse | fails |" in call("cost_table", out / "study")
    assert "did not converge" in call("limits_table", out / "study")
    # Last, since what reads it is not in Debian's smaller package of VTK.
    call("plot_points.py", out / "upsetting", out / "hdf5", FIELD, out / "hdf5.svg")
    images = re.findall(r'data:image/png;base64,([^"]+)"', (out / "hdf5.svg").read_text())
    assert len(images[0]) > 5000 and images[0] == images[1]


class Page(html.parser.HTMLParser):
    """Texts of the elements of a page, addresses that it names."""

    def __init__(self, text):
        super().__init__()
        self.texts, self.addresses, self.attributes, self.open = {}, [], {}, []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.attributes.setdefault(tag, []).append(attributes)
        self.addresses += [attributes[key] for key in ("src", "href") if key in attributes]
        self.open.append(tag)

    def handle_endtag(self, tag):
        while self.open and self.open.pop() != tag:
            pass

    def handle_data(self, data):
        if self.open and data.strip():
            self.texts.setdefault(self.open[-1], []).append(data.strip())


# Tells what has become of the page when it is there.
PROBE = """<script>addEventListener("load", () => { document.body.dataset.found = JSON.stringify({
  images: [...document.images].map(image => image.complete && image.naturalWidth > 0),
  wide: document.documentElement.scrollWidth > innerWidth,
  fetched: performance.getEntriesByType("resource").map(entry => entry.name),
}) })</script>"""


def chromium(*words):
    path = shutil.which("chromium")
    if not path:
        skip("Debian's chromium is not installed")
    profile = options.output / "chromium"
    return run(path, "--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr",
               "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={profile}",
               "--window-size=1280,2000", *words)


def report():
    """Pages that need nothing but themselves, and show in a browser."""
    out = options.output
    pages = {
        "single": (["upsetting"], "upsetting of a steel cylinder", "done", 5),
        "compared": (["upsetting", "long_steps"], "upsetting of a steel cylinder", "all 2 done", 6),
        "solid": (["solid", "--field", FIELD], "upsetting, a quarter in 3D", "done", 4),
        "failed": (["failed"], "upsetting of a steel cylinder", "failed", 2),
        "unfinished": (["unfinished"], "upsetting of a steel cylinder", "unfinished", 4),
        "stopped": (["stopped"], "upsetting of a steel cylinder", "unfinished", 4),
        "study": (["study"], "stretched block", "4 of 6 done", 4),
        "begun": (["begun"], "stretched block", "2 of 6 done", 1),
        "bare": (["bare"], "stretched block", "0 of 6 done", 0),
    }
    for name, (words, title, badge, n_figures) in pages.items():
        path = out / f"{name}.html"
        words = [out / word if (out / word).exists() else word for word in words]
        call("report", *words, "-o", path)
        text = path.read_text()
        page = Page(text)
        assert page.texts["h1"] == [title], page.texts["h1"]
        assert badge in page.texts["span"], page.texts["span"]
        captions = page.texts.get("figcaption", [])
        assert len(captions) >= n_figures, captions
        images = page.attributes.get("img", [])
        assert len(images) == len(captions)
        assert all(address.startswith(("data:", "#")) for address in page.addresses)
        assert "url(" not in text and "@import" not in text and "<script" not in text
        for image in images:
            kind, _, content = image["src"].partition(",")
            drawing = base64.b64decode(content).decode()
            assert kind == "data:image/svg+xml;base64" and "currentColor" in drawing
            assert "nan" not in drawing.split("<defs>")[0]
    for name in ("failed", "study"):
        assert "did not converge" in (out / f"{name}.html").read_text()

    for name in ("single", "compared", "failed", "study"):
        probed = out / f"{name}_probed.html"
        probed.write_text((out / f"{name}.html").read_text().replace("</body>", PROBE + "</body>"))
        result = chromium("--dump-dom", probed.as_uri())
        assert "CONSOLE" not in result.stderr, result.stderr
        body = Page(result.stdout).attributes["body"][0]
        found = json.loads(body["data-found"])
        assert found["images"] and all(found["images"]), found
        assert not found["wide"], "wider than the window"
        assert all(url.startswith("data:") for url in found["fetched"]), found["fetched"]
    picture = out / "single.png"
    chromium(f"--screenshot={picture}", (out / "single.html").as_uri())
    from matplotlib.image import imread

    pixels = imread(picture)
    assert pixels.shape[:2] == (2000, 1280) and 0.01 < (pixels[..., :3] < 0.9).mean() < 0.9


def paraview():
    """Of a body about an axis, and in space."""
    pvpython = shutil.which("pvpython")
    if not pvpython:
        skip("Debian's python3-paraview is not installed")
    if not shutil.which("xvfb-run"):
        skip("Debian's xvfb is not installed")
    from matplotlib.image import imread

    script = options.contrib / "paraview_upsetting.py"
    by = ["xvfb-run", "-a", "-s", "-noreset -screen 0 1280x1024x24", pvpython, script]
    for name in ("upsetting", "solid"):
        picture = options.output / f"paraview_{name}.png"
        result = run(*by, options.output / name, "--picture", picture)
        assert result.returncode == 0 and picture.is_file(), result.stderr
        pixels = imread(picture)[..., :3]
        coloured = (pixels.max(axis=2) - pixels.min(axis=2) > 0.2).mean(axis=0)
        assert coloured.mean() > 0.03, coloured.mean()
        if name == "upsetting":  # the mirror image
            assert abs(coloured - coloured[::-1]).mean() < 0.2 * coloured.mean()
    result = run(*by, options.output / "upsetting", "--field", "colour")
    assert result.returncode == 1 and "no field 'colour'" in result.stderr, result.stderr


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("test", choices=["help", "figures", "runs", "refusals", "plots", "report", "paraview"])
for name in ("contrib", "scenes", "program", "output"):
    parser.add_argument("--" + name, type=Path, required=True)
options = parser.parse_args()
for name in ("contrib", "scenes", "program", "output"):
    setattr(options, name, getattr(options, name).resolve())
globals()[options.test]()

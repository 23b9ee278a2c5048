"""The pages that `rouleau report` makes, as headless Chromium shows them. Needs chromium and Python's standard library.

usage: check_report.py ROULEAU PLUGIN_FOLDER SOURCE_FOLDER [--shots FOLDER]    (a screenshot of every page checked)
"""
import base64
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from browser import SCREENS, Browser, BrowserCase, main

PROGRAM, PLUGINS, SOURCE = (Path(a).resolve() for a in sys.argv[1:4])
SHOTS = Path(sys.argv[5]) if sys.argv[4:5] == ["--shots"] else None
SCENE = SOURCE / "scenes" / "four-cells-shear.json"
LARGEST_PAGE = 3_000_000

# No fewer outputs (103) and fields (17) than the demo has, on as many nodes, in a fifteenth of its strain.
LIKE_THE_DEMO = ["--set", "/stages/0/duration=0.02", "--set", "/stages/1/strain=1",
                 "--set", '/output={"cells": {"strain": 0.01}, "fields": {"strain": 0.06, "quantities": ["velocity", "viscosity"]}}']
STRONGER = ["--set", '/interactions/0/parameters/depth="1.3e-6 J/m2"', "--set", '/stages/1/shear_rate="25 1/s"']


def rouleau(*arguments):
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120,
                            env={**os.environ, "ROULEAU_PLUGIN_PATH": str(PLUGINS)})
    if result.returncode not in (0, 1):
        raise RuntimeError(f"rouleau {' '.join(map(str, arguments))}: {result.stderr}")
    return result


def table(name):
    with open(folder / name, newline="") as file:
        return list(csv.reader(file))


def setUpModule():
    global folder, browser
    folder = Path(tempfile.mkdtemp(prefix="rouleau-report-"))
    rouleau("run", SCENE, "--out", folder / "a", "--quiet", *LIKE_THE_DEMO)
    rouleau("run", SCENE, "--out", folder / "b", "--quiet", *LIKE_THE_DEMO, *STRONGER)
    rouleau("report", "--compare", folder / "a", folder / "b", "--out", folder / "both.html")
    browser = BrowserCase.browser = Browser()


def tearDownModule():
    browser.__exit__()
    shutil.rmtree(folder, ignore_errors=True)


OVER = """(v => { const s = document.querySelector('select[aria-label="Horizontal axis"]'); s.value = v; s.dispatchEvent(new Event('change')); })"""


class PageCase(BrowserCase):
    def assert_sound(self, page, width=None):
        """No exception, no word on the console, nothing fetched, nothing wider than the screen."""
        self.assertEqual(page.faults(), [])
        if width:
            self.assertLessEqual(page.run("document.scrollingElement.scrollWidth"), width)


class A_run_without_attraction(PageCase):
    """A driven channel whose cells touch, and nothing attracts them."""

    @classmethod
    def setUpClass(cls):
        cls.directory = folder / "channel"
        rouleau("run", SOURCE / "scenes/channel.json", "--out", cls.directory, "--quiet", "--max-steps", "300", "--set", '/output/cells={"seconds": 0.0002}')

    def test_is_not_told_as_aggregation(self):
        page = self.open(self.directory / "report.html")
        text = page.run("document.body.innerText.replace(document.querySelector('h1').innerText, '').replace(document.querySelector('footer').innerText, '').replaceAll('rouleau run --error-bar', '').replaceAll('Aggregate size', '?')")
        self.assertGreater(page.run("Math.max(...timeline.runs[0].summary.aggregate_history.flatMap(h => h.members.map(m => m.length)))"), 1)
        self.assertNotRegex(text, r"(?i)rouleau[x ]|aggregat|joined|broke|break-up")
        self.assertEqual(page.run("document.querySelectorAll('.story button, button.event:not(.stage)').length"), 0)
        self.assertEqual(page.run("document.querySelector(\"select[aria-label='Cells by']\").value"), "cell")
        self.assertIn("Cells that are close (gaps below 0.75 µm); nothing joins them", page.run("document.querySelector('main').textContent"))
        self.assert_sound(page)

    def test_has_results_with_the_digits_that_they_have_and_the_units_that_they_need(self):
        page = self.open(self.directory / "report.html")
        summary = json.loads((self.directory / "summary.json").read_text())
        means = summary["rheology"][-1]["means"]
        result = page.run("document.querySelector('.result').innerText")
        self.assertIn("No error bars were measured", result)
        self.assertRegex(result, r"mean velocity\s+[0-9]{2,4} µm/s")
        self.assertNotIn("Mach", result)
        self.assertNotIn("cell-free", result)  # most columns of so short a run in so empty a channel have no cell
        self.assertGreater(means["cell_free_layer_empty"]["mean"], 0.05)
        viscosity = page.run("resultOf(timeline.runs[0]).numbers.find(n => n.label === 'relative viscosity').value")
        self.assertLessEqual(len(viscosity.replace(".", "")), 3)
        row = page.run("(() => { const row = [...document.querySelectorAll('tr')].find(r => r.innerText.startsWith('Pressure gradient') || r.firstChild.textContent.startsWith('Pressure gradient'));"
                       " return [...row.children].map(c => c.textContent); })()")
        self.assertEqual(row[0], "Pressure gradient, Pa/m")
        self.assertAlmostEqual(float(row[4].replace("\u202f", "")) / means["pressure_gradient_Pa_per_m"]["mean"], 1, delta=0.01)

    def test_names_every_column_with_its_unit(self):
        drawn = {"": ("", 1), "s": (", s", 1), "m": (", µm", 1e6), "rad": (", °", 180 / 3.141592653589793), "m2": (", µm²", 1e12), "m3": (", µm³", 1e18),
                 "1/s": (", 1/s", 1), "Pa": (", Pa", 1), "Pa/m": (", Pa/m", 1), "m2/s": (", µm²/s", 1e12), "m3/s": (", µm³/s", 1e18), "m/s": (", µm/s", 1e6), "J/m": (", J/m", 1), "W/m": (", W/m", 1)}
        columns = [column for t in json.loads(rouleau("columns").stdout) for column in t["columns"]]
        page = self.open(self.directory / "report.html")
        found = page.run(f"{json.dumps([column['column'] for column in columns])}.map(drawnAs)")
        for column, shown in zip(columns, found, strict=True):
            with self.subTest(column["column"]):
                unit, factor = drawn[column["unit"]]
                self.assertEqual(shown["factor"], factor)
                self.assertEqual("," + shown["title"].partition(",")[2] if "," in shown["title"] else "", unit)
        endings = page.run("endings.map(e => e[0])")
        self.assertEqual(endings, sorted(endings, key=lambda e: -len(e)))
        self.assertEqual(page.run("spelled('steps_per_s')"), "Steps per s")

    def test_beside_one_with_attraction_is_neither(self):
        rouleau("report", "--compare", self.directory, folder / "a", "--out", folder / "mixed.html")
        page = self.open(folder / "mixed.html")
        titles = page.run("[...document.querySelectorAll('.chart h3')].map(h => h.textContent)")
        self.assertIn("Groups of close cells, single cells included", titles)
        self.assertFalse([title for title in titles if title.startswith("Aggregates")])
        self.assert_sound(page)


class Every_page_on_every_screen(PageCase):
    FILES = {"run": "a/report.html", "comparison": "both.html"}

    def pages(self):
        for name, file in self.FILES.items():
            for screen in SCREENS:
                for scheme in ("light", "dark"):
                    with self.subTest(page=name, screen=screen, scheme=scheme):
                        yield name, screen, scheme, self.open(folder / file, screen, scheme)

    def test_shows_cells_and_charts_and_does_what_its_controls_say(self):
        for name, screen, scheme, page in self.pages():
            self.play_and_scrub(page)
            self.show_the_flow(page)
            self.hide_a_line(page)
            self.assertGreaterEqual(page.run("document.querySelectorAll('.uplot canvas').length"), 9)
            self.assert_sound(page, SCREENS[screen]["width"])
            if SHOTS:
                SHOTS.mkdir(parents=True, exist_ok=True)
                (SHOTS / f"{name}-{screen}-{scheme}.png").write_bytes(base64.b64decode(page.screenshot()))

    VIEWS = "[...document.querySelectorAll('canvas.view')].map(c => c.toDataURL()).join()"
    DRAWN = "new Promise(r => requestAnimationFrame(() => requestAnimationFrame(() => r(true))))"

    def button(self, page, text):
        return f"[...document.querySelectorAll('button')].find(b => b.textContent === {json.dumps(text)})"

    def play_and_scrub(self, page):
        page.run("timeline.seek(0)")
        first = page.run(self.VIEWS)
        page.run(self.button(page, "Play") + ".click()")
        page.wait("timeline.position > 2")
        self.assertNotEqual(page.run(self.VIEWS), first, "the animation does not move")
        page.run(self.button(page, "Pause") + ".click()")
        self.assertFalse(page.run("timeline.playing"))

        seek = "(p => { const s = document.querySelector('input[type=range]'); s.value = p; s.dispatchEvent(new Event('input')); })"
        last = page.run("timeline.count - 1")
        page.run(f"{seek}({last})")
        end = page.run(self.VIEWS)
        words = page.run("document.querySelector('.now').textContent")
        page.run(f"{seek}(0)")
        self.assertEqual(page.run(self.VIEWS), first, "the first instant looks otherwise than before")
        self.assertNotEqual(end, first)
        self.assertNotEqual(page.run("document.querySelector('.now').textContent"), words)
        # At the end playing begins anew; it stops there by itself.
        page.run(f"{seek}({last}); document.querySelector('select[aria-label=Speed]').value = '4'; " + self.button(page, "Play") + ".click()")
        page.wait("timeline.playing && timeline.position < 20")
        page.run(f"{seek}({last - 4}); " + self.button(page, "Play") + ".click()")
        page.wait("!timeline.playing && timeline.position === timeline.count - 1")

    def show_the_flow(self, page):
        flow = "document.querySelector('select[aria-label=Flow]')"
        choose = f"(v => {{ const s = {flow}; s.value = v; s.dispatchEvent(new Event('change')); }})"
        looks = [page.run(self.VIEWS)]
        for value, bar in (("speed", "Velocity magnitude, µm/s"), ("vorticity", "Vorticity, 1/s")):
            page.run(f"{choose}('{value}')")
            self.assertIn(bar, page.run("document.querySelector('.bar:not(.cells)').textContent"))
            looks.append(page.run(self.VIEWS))
        page.run(f"{choose}('')")
        self.assertEqual(page.run("document.querySelector('.bar:not(.cells)').textContent"), "")
        self.assertEqual(page.run(self.VIEWS), looks[0])
        self.assertEqual(len(set(looks)), 3, "two flows look the same")

    def hide_a_line(self, page):
        chart = "charts.find(c => c.lines.length > 1)"
        picture = f"{chart}.u.ctx.canvas.toDataURL()"
        before = page.run(f"{self.DRAWN}.then(() => {picture})")
        click = f"{chart}.keys[0].button.click()"
        page.run(click)
        self.assertEqual(page.run(f"{chart}.keys[0].button.getAttribute('aria-pressed')"), "false")
        self.assertNotEqual(page.run(f"{self.DRAWN}.then(() => {picture})"), before, "the line is still there")
        page.run(click)
        self.assertEqual(page.run(f"{chart}.keys[0].button.getAttribute('aria-pressed')"), "true")


class A_chart_under_the_mouse(PageCase):
    def place(self, page, chart, share):
        """Point of the screen at a share of a chart's width."""
        box = page.run(f"(() => {{ charts[{chart}].u.over.scrollIntoView({{block: 'center'}}); const r = charts[{chart}].u.over.getBoundingClientRect();"
                       f" return [r.left + {share} * r.width, r.top + r.height / 2]; }})()")
        return box

    def test_moves_the_instant_of_all_charts_and_of_the_animation(self):
        for file in ("a/report.html", "both.html"):
            page = self.open(folder / file)
            page.wait("charts[1].u.status === 1")
            page.run(OVER + "('strain')")
            view = page.run(Every_page_on_every_screen.VIEWS)
            page.mouse("mouseMoved", *self.place(page, 1, 0.75))
            page.wait("Math.abs(timeline.place() - 0.75) < 0.02")
            self.assertNotEqual(page.run(Every_page_on_every_screen.VIEWS), view)
            words = page.run("[...document.querySelectorAll('.legend .instant')].filter(e => !e.closest('details:not([open])')).map(e => e.textContent)")
            self.assertEqual(len(set(words)), 1, words)
            self.assertIn("at strain 0.7", words[0])
            lines = page.run("charts.filter(c => !c.folded).map(c => c.u.cursor.left / c.u.over.clientWidth)")
            for share in lines:
                self.assertAlmostEqual(share, 0.75, delta=0.03)
            self.assertEqual(page.faults(), [])

    def test_shows_a_stretch_in_all_charts_after_a_drag_and_all_again_after_a_double_click(self):
        page = self.open(folder / "a/report.html")
        page.wait("charts[1].u.status === 1")
        page.run(OVER + "('strain')")
        begin, end = self.place(page, 1, 0.25), self.place(page, 1, 0.5)
        page.mouse("mouseMoved", *begin)
        page.mouse("mousePressed", *begin, button="left", clickCount=1)
        for share in (0.3, 0.4, 0.5):
            page.mouse("mouseMoved", *self.place(page, 1, share), button="left", buttons=1)
        page.mouse("mouseReleased", *end, button="left", clickCount=1)
        page.wait("zoomed !== null && charts.every(c => c.u.scales.x.max < 0.6)")
        for low, high in page.run("charts.map(c => [c.u.scales.x.min, c.u.scales.x.max])"):
            self.assertAlmostEqual(low, 0.25, delta=0.02)
            self.assertAlmostEqual(high, 0.5, delta=0.02)
        for click in (1, 2):
            page.mouse("mousePressed", *end, button="left", clickCount=click)
            page.mouse("mouseReleased", *end, button="left", clickCount=click)
        page.wait("zoomed === null && charts.every(c => c.u.scales.x.max > 0.99)")
        self.assertEqual(page.faults(), [])

    def test_has_the_axis_that_was_chosen(self):
        page = self.open(folder / "a/report.html")
        for over, last in (("time_s", page.run("data.time_s.at(-1)")), ("stages", page.run("data.step.length - 1")), ("strain", page.run("data.strain.at(-1)"))):
            page.run(f"{OVER}('{over}')")
            page.wait(f"charts.every(c => Math.abs(c.u.scales.x.max - {last}) <= 1e-9 * {last})")
        self.assertEqual(page.faults(), [])


class The_axis_of_a_chart(PageCase):
    def test_has_numbers_that_differ(self):
        page = self.open(folder / "a/report.html")
        for values, step, words in (([90, 90.0005, 90.001], .0005, ["90", "90.0005", "90.001"]), ([-2.5, 0, 2.5], 2.5, ["−2.5", "0", "2.5"]),
                                    ([123456, 123457], 1, ["1.23456e5", "1.23457e5"]), ([0.1, 0.2, 0.30000000000000004], .1, ["0.1", "0.2", "0.3"]),
                                    ([2e-5, 4e-5], 2e-5, ["2e-5", "4e-5"])):
            self.assertEqual(page.run(f"axisNumbers(null, {values}, 1, 32, {step})"), words)

    def test_shows_a_value_without_neighbours_as_a_dot(self):
        page = self.open(folder / "a/report.html")
        self.assertEqual(page.run("lonely([1, null, 2, undefined, 3, null, undefined, 4])"), [0, 7])
        self.assertEqual(page.run("lonely([undefined, 1, undefined])"), [1])


class On_paper(PageCase):
    def test_charts_are_dark_on_white_whatever_the_screen_was_and_nothing_stays_folded(self):
        for file in ("a/report.html", "both.html"):
            page = self.open(folder / file, scheme="dark")
            page.run("""addEventListener('beforeprint', () => { window.seen = {page: css('--page'), text: css('--text'), open: !document.querySelector('details:not([open])'),
                        fine: charts.every(c => c.style.paper)}; }); null""")
            self.assertGreater(len(page.print_pdf()), 10000)
            self.assertEqual(page.run("window.seen"), {"page": "#fff", "text": "#000", "open": True, "fine": True})
            page.wait("!printing && charts.every(c => !c.style.paper)")
            self.assertEqual(page.run("css('--page')"), "#14171b")
            self.assertFalse(page.run("[...document.querySelectorAll('details')].some(d => d.open)"))
            self.assertEqual(page.faults(), [])


class The_page_of_a_run(PageCase):
    def headings(self, page):
        return page.run("[...document.querySelectorAll('h2')].map(h => h.textContent)")

    def report(self, *options, scene=SCENE):
        directory = folder / self.id()
        shutil.rmtree(directory, ignore_errors=True)
        rouleau("run", scene, "--out", directory, "--quiet", *options)
        return directory / "report.html"

    def scene(self, **changes):
        file = folder / f"{self.id()}.json"
        file.write_text(json.dumps({**json.loads(SCENE.read_text()), **changes}))
        return file

    def test_is_small_enough_to_be_sent(self):
        self.assertGreaterEqual(len(table("a/series.csv")), 1 + 103)
        for file in ("a/report.html", "both.html"):
            self.assertLess((folder / file).stat().st_size, LARGEST_PAGE, file)

    def test_has_its_parts_in_the_order_of_their_weight(self):
        page = self.open(folder / "a/report.html")
        self.assertEqual(self.headings(page), ["Cells", "Charts", "Details", "Aggregates", "Means", "Dimensionless numbers", "Scene and conversions", "Limits and margins",
                                                "Not computed in this run", "Conservation", "Cost", "Time by pass", "Stages", "Plugins", "Provenance"])
        self.assertIn("Permission is hereby granted", page.run("document.querySelector('main').textContent"))

    def test_has_its_warnings_below_its_result(self):
        # A well that the lattice does not resolve is warned of.
        page = self.open(self.report("--max-steps", "20", "--set", '/interactions/0/parameters/zero_force_distance="0.3 um"'))
        boxes = page.run("[...document.querySelectorAll('.status strong')].map(e => e.textContent)")
        self.assertIn("Cut short by the limit of steps at step 20 of at most", boxes[0])
        self.assertIn("arning", boxes[1])
        self.assert_sound(page)

    def test_has_no_heading_for_cells_that_are_not_there_and_no_axis_for_what_is_zero(self):
        page = self.open(self.report(scene=self.scene(
            cell_types={}, cells=[], interactions=[], output={"cells": {"seconds": "10 us"}, "fields": {"seconds": "10 us", "quantities": ["velocity"]}},
            stages=[{"name": "flow", "duration": "30 us", "pressure_gradient": "1 kPa/m"}])))
        self.assertEqual(self.headings(page)[0], "Flow")
        titles = page.run("[...document.querySelectorAll('.chart h3')].map(h => h.textContent)")
        self.assertFalse([t for t in titles if t.startswith("Relative mass drift")])
        self.assertIn("Largest Mach number, 10⁻⁶", titles)  # as a multiple that can be read
        self.assertIn("zero at every output: relative mass drift", page.run("document.querySelector('main').textContent"))
        self.assertEqual(page.run("timeline.over"), "time_s")
        self.assert_sound(page)

    def test_finds_the_output_of_an_event_although_its_own_times_are_rounded(self):
        times = [float(row[1]) for row in table("a/series.csv")[1:]]
        self.assertGreater(sum(float(f"{time:.9g}") < time for time in times), 20)
        page = self.open(folder / "a" / "report.html")
        data = "JSON.parse(document.getElementById('data').textContent)"
        found = page.run(f"(run => {times}.map(time => outputAt(run, time)))({data})")
        self.assertEqual(found, list(range(len(times))))

    def test_says_as_the_terminal_from_when_on_all_are_single(self):
        """Though two come close once more, without a bond."""
        single, apart = [[0], [1], [2], [3]], [[0], [1, 2], [3]]
        page = self.open(folder / "a" / "report.html")
        found = page.run("""(history => joinHistory({...data, summary: {...data.summary, aggregate_history: history}}).map(h => [h.strain, h.count]))(%s)""" % json.dumps(
            [{"strain": 0, "count": 4, "members": single, "through_image": False}, {"strain": 1, "count": 3, "members": apart, "through_image": False},
             {"strain": 10, "count": 4, "members": single, "through_image": False},
             {"strain": 12, "count": 3, "members": apart, "joined": single, "through_image": False},
             {"strain": 13, "count": 4, "members": single, "through_image": False}]))
        self.assertEqual(found, [[0, 4], [1, 3], [10, 4]])

    def test_of_a_run_that_was_killed_says_so(self):
        directory = folder / "killed"
        shutil.copytree(folder / "a", directory)
        (directory / "summary.json").unlink()
        rouleau("report", directory)
        page = self.open(directory / "report.html")
        self.assertEqual(page.run("document.querySelector('h1').textContent"), json.loads((directory / "scene.json").read_text())["title"])
        self.assertIn("Not finished", page.run("document.querySelector('.status').textContent"))
        self.assertGreater(page.run("charts.length"), 5)
        self.assert_sound(page)

    def changed(self, name, change, damage=None):
        """The page of run a with another summary.json; `damage` is put where the program tells of damaged files."""
        directory = folder / name
        shutil.copytree(folder / "a", directory)
        summary = json.loads((directory / "summary.json").read_text())
        change(summary)
        (directory / "summary.json").write_text(json.dumps(summary))
        rouleau("report", directory)
        if damage:
            file = directory / "report.html"
            begin, rest = file.read_text().split('<script type="application/json" id="data">', 1)
            data, end = rest.split("</script>", 1)
            data = json.loads(data)
            data["shown"].update(damage=damage, note="No animation: frames.h5 cannot be read.")
            data["outlines"] = data["fields"] = None
            file.write_text(f'{begin}<script type="application/json" id="data">{json.dumps(data)}</script>{end}')
        page = self.open(directory / "report.html")
        self.assert_sound(page)
        return page

    def conversions(self, page):
        found = page.run("(() => { const h = [...document.querySelectorAll('h3')].find(h => h.textContent === 'Every conversion'); return"
                         " [...h.nextElementSibling.querySelectorAll('tr')].map(tr => [...tr.children].map(cell => cell.textContent)); })()")
        return found[0], found[1:]

    def test_has_every_conversion_with_the_cells_it_belongs_to(self):
        def row(quantity, si, stage="shear", **more):
            return {"quantity": quantity, "si": si, "lattice": si, "unit": "m", "stage": stage, **more}
        head, rows = self.conversions(self.changed("of", lambda s: s.update(conversions=[
            row(q, si + later, stage, of=of) for later, stage in enumerate(("first", "second"))
            for q, si, of in (("spacing", 1, ""), ("a: modulus", 2, "rbc"), ("a: modulus", 3, "rbc #2"), ("m: depth", 4, "rbc, rbc"), ("m: depth", 5, "rbc, rbc"))])))
        self.assertEqual(head, ["Quantity", "Of", "Unit", "SI (first)", "Lattice (first)", "SI (second)", "Lattice (second)"])
        self.assertEqual([r[:2] + r[3:] for r in rows], [[q, of] + [str(si)] * 2 + [str(si + 1)] * 2 for q, of, si in (
            ("spacing", "", 1), ("a: modulus", "rbc", 2), ("a: modulus", "rbc #2", 3), ("m: depth", "rbc, rbc", 4), ("m: depth", "rbc, rbc", 5))])
        # Of an earlier version, which does not say what they belong to.
        head, rows = self.conversions(self.changed("not-of", lambda s: s.update(conversions=[row("m: depth", si) for si in (1, 2, 3)])))
        self.assertEqual(head, ["Quantity", "Unit", "SI", "Lattice"])
        self.assertEqual([r[2] for r in rows], ["1", "2", "3"])

    def test_says_whether_an_interrupted_run_can_go_on(self):
        def interrupt(summary, **step):
            summary.pop("checkpoint_step", None)
            summary.update(status="interrupted", **step)
        for name, step, words in (("kept", {"checkpoint_step": 1234}, "The same command with --resume goes on from step 1\u202f234."),
                                  ("not-kept", {"checkpoint_step": None}, "No checkpoint was kept, so that it can only begin again."),
                                  ("unsaid", {}, "continue it with --resume.")):
            page = self.changed(name, lambda s: interrupt(s, **step))
            self.assertIn(words, page.run("document.querySelector('[role=status]').textContent"))

    def test_begins_with_what_is_damaged(self):
        page = self.changed("damaged", lambda s: s.update(warnings=["a warning"], resumed=[
            {"step": 5000, "threads": 1, "accepted": []}, {"step": 7000, "threads": 1, "accepted": [], "damaged_checkpoint": "checkpoint.h5 is damaged: its checksum is wrong"}]),
            damage=["frames.h5 is damaged; run again", "cells.csv is cut short"])
        boxes = page.run("[...document.querySelectorAll('.status')].map(e => [e.querySelector('strong').textContent, ...[...e.querySelectorAll('li')].map(li => li.textContent)])")
        self.assertEqual(boxes[0], ["Some of the run's files are damaged", "frames.h5 is damaged; run again", "cells.csv is cut short"])
        self.assertEqual(boxes[2][:2], ["2 warnings", "a warning"])
        self.assertIn("at step 7\u202f000: checkpoint.h5 is damaged", boxes[2][2])
        self.assertEqual(page.run("document.querySelector('h1').nextElementSibling.nextElementSibling.querySelector('strong').textContent"), boxes[0][0])
        # Why there is no animation stands where it would be.
        self.assertEqual(page.run("document.querySelector('.stage').firstElementChild.textContent"), "No animation: frames.h5 cannot be read.")
        self.assertFalse(page.run("!!document.querySelector('canvas.view')"))

    def test_of_a_diverged_run_shows_the_last_instant_with_the_place_marked(self):
        failure = {"reason": "node_step", "step": 9999, "strain": 1, "time_s": 1, "place_m": [20e-6, 12e-6], "cell": 1, "value": 1, "limit": 0.5, "message": "", "remedy": ""}
        page = self.changed("diverged", lambda s: s.update(status="diverged", failure=failure))
        self.assertEqual(page.run("timeline.position"), page.run("timeline.count - 1"))
        self.assertIn("the red ring marks the place", page.run("document.querySelector('.stage').textContent"))
        marked = page.run(Every_page_on_every_screen.VIEWS)
        page.run("data.summary.failure = null; timeline.seek(timeline.position)")
        self.assertNotEqual(page.run(Every_page_on_every_screen.VIEWS), marked)

    def test_of_a_run_without_any_output_is_still_a_page(self):
        directory = folder / "empty"
        shutil.copytree(folder / "a", directory)
        for name in ("series.csv", "cells.csv"):
            text = (directory / name).read_text()
            (directory / name).write_text(text.splitlines()[0] + "\n")
        rouleau("report", directory)
        page = self.open(directory / "report.html")
        self.assertIn("No output has been written.", page.run("document.querySelector('main').textContent"))
        self.assert_sound(page)

    def test_draws_the_energy_ledger_where_the_run_kept_one(self):
        directory = folder / "ledger"
        shutil.copytree(folder / "a", directory)
        rows = table("ledger/series.csv")
        names = ["kinetic_energy_J_per_m", "elastic_energy_J_per_m", "bending_energy_J_per_m", "interaction_energy_J_per_m", "total_energy_J_per_m",
                 "viscous_dissipation_W_per_m", "wall_power_W_per_m"]
        with open(directory / "series.csv", "w", newline="") as file:
            writer = csv.writer(file)
            for i, row in enumerate(rows):
                writer.writerow(row + [n for n in names if n not in row] if i == 0 else row + [f"{i}e-15"] * (len(names) - sum(n in rows[0] for n in names)))
        rouleau("report", directory)
        for file, lines in (("ledger/report.html", [4, 1, 3]), ("a/report.html", [None] * 3)):
            page = self.open(folder / file)
            found = page.run("['Energy of the cells', 'Kinetic energy of the fluid as simulated', 'Power'].map(title => charts.find(c => "
                             "c.plot.parentNode.getAttribute('aria-label') === title)?.lines.length ?? null)")
            if lines[0] or "total_energy_J_per_m" not in rows[0]:
                self.assertEqual(found, lines)
            self.assert_sound(page)


class The_page_of_a_run_in_three_dimensions(PageCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser(draws_space=True)
        cls.directory = folder / "space"
        rouleau("run", SOURCE / "scenes/capsule-3d.json", "--out", cls.directory, "--quiet", "--set", "/domain/nodes=[32, 32, 32]",
                "--set", "/stages/0/strain=0.4", "--set", "/output/cells/strain=0.05")

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()

    PIXELS = """(() => { const c = document.querySelector("canvas.space"), gl = c.getContext("webgl2") ?? c.getContext("webgl"), p = new Uint8Array(4 * c.width * c.height);
        gl.readPixels(0, 0, c.width, c.height, gl.RGBA, gl.UNSIGNED_BYTE, p); let sum = 0, seen = 0; for (let i = 0; i < p.length; i += 4) if (p[i + 3]) { ++seen; sum = (sum + (i / 4) * p[i]) % 1000003; } return [seen, sum]; })()"""

    def test_shows_surfaces_that_turn_and_follow_the_instant(self):
        for screen, scheme in (("desktop", "light"), ("phone", "dark")):
            page = self.open(self.directory / "report.html", screen, scheme, part="#strain=0.4")
            page.run(Every_page_on_every_screen.DRAWN)
            seen, first = page.run(self.PIXELS)
            self.assertGreater(seen, 500)
            page.run("document.querySelector('canvas.space').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}))")
            turned = page.run(self.PIXELS)[1]
            self.assertNotEqual(turned, first)
            page.run("document.querySelector('canvas.space').dispatchEvent(new KeyboardEvent('keydown', {key: '0', bubbles: true}))")
            self.assertEqual(page.run(self.PIXELS)[1], first)
            page.run("timeline.seek(0)")
            self.assertNotEqual(page.run(self.PIXELS)[1], first)
            self.assert_sound(page, SCREENS[screen]["width"])

    def test_draws_a_cell_while_it_is_there(self):
        begin, rest = (self.directory / "report.html").read_text().split('<script type="application/json" id="data">', 1)
        data, end = rest.split("</script>", 1)
        data = json.loads(data)
        first, last = 2, len(data["step"]) - 3  # at these outputs and between
        cells = data["cells"]
        cells["ids"], cells["from"] = [7], [first]
        for name, lines in cells.items():
            if name == "aggregate":
                cells[name] = [[7] if first <= k <= last else [] for k in range(len(lines))]
            elif name not in ("ids", "types", "from"):
                cells[name] = [lines[0][first:last + 1]]
        drawn = data["surfaces"]
        drawn["cells"] = [7]
        for k, output in enumerate(drawn["outputs"]):
            if not first <= output <= last:
                drawn["there"][k], drawn["nodes"][k], drawn["origin_um"][k], drawn["tension"]["values"][k] = [], "", [], ""
        file = self.directory / "coming.html"
        file.write_text(f'{begin}<script type="application/json" id="data">{json.dumps(data)}</script>{end}')
        page = self.open(file)
        page.run(Every_page_on_every_screen.DRAWN)
        for colour in page.run("[...document.querySelector('select[aria-label=\"Cells by\"]').options].map(o => o.value)"):
            page.run(f"(s => {{ s.value = '{colour}'; s.dispatchEvent(new Event('change')); }})(document.querySelector('select[aria-label=\"Cells by\"]'))")
            seen = {}
            for place in (0, first - .6, first - .4, first, last, last + .4, last + .6, last + 2):
                page.run(f"timeline.seek({place})")
                there = page.run("timeline.animation.outlines.has(timeline.animation.shapes(), 0)")
                self.assertEqual(there, first - .5 < place < last + .5, (colour, place))
                seen.setdefault(there, set()).add(page.run(self.PIXELS)[0])
            self.assertEqual(len(seen[False]), 1, "a cell that is not there is drawn")
            self.assertGreater(min(seen[True]), max(seen[False]) + 200, "a cell that is there is not drawn")
        self.assertEqual(page.run("charts.flatMap(c => c.lines).filter(l => l.cell === 0).map(l => l.label)[0]"), "cell 7")
        page.run("document.querySelector('select[aria-label=Cell]').value = '0'")
        page.run("document.querySelector('select[aria-label=Cell]').dispatchEvent(new Event('change'))")
        page.run("[...document.querySelectorAll('label')].find(l => l.textContent === 'Follow').querySelector('input').click()")
        for place in (0, first, last + 2):
            page.run(f"timeline.seek({place})")
        self.assert_sound(page)

    def test_leaves_the_wheel_and_one_finger_to_the_page(self):
        page = self.open(self.directory / "report.html", part="#strain=0.4")
        page.run(Every_page_on_every_screen.DRAWN)
        first = page.run(self.PIXELS)
        wheel = "!document.querySelector('canvas.space').dispatchEvent(new WheelEvent('wheel', {deltaY: -300, ctrlKey: %s, bubbles: true, cancelable: true}))"
        self.assertFalse(page.run(wheel % "false"), "the page cannot scroll")
        self.assertEqual(page.run(self.PIXELS), first)
        self.assertTrue(page.run(wheel % "true"))
        self.assertGreater(page.run(self.PIXELS)[0], first[0])

        page = self.open(self.directory / "report.html", "phone", part="#strain=0.4")
        page.run("document.querySelector('canvas.space').scrollIntoView({block: 'center'})")
        page.run(Every_page_on_every_screen.DRAWN)
        x, y = page.run("(r => [r.left + r.width / 2, r.top + r.height / 2])(document.querySelector('canvas.space').getBoundingClientRect())")

        def fingers(kind, *places):
            page.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": a, "y": b, "id": k} for k, (a, b) in enumerate(places)])

        first, scroll = page.run(self.PIXELS), page.run("scrollY")
        fingers("touchStart", (x, y))
        for step in (10, 40, 80, 120):
            fingers("touchMove", (x, y - step))
        fingers("touchEnd")
        page.wait(f"scrollY > {scroll + 30}")
        # The page may glide on for a while.
        page.run(f"new Promise(r => {{ const still = () => {{ const y = scrollY; setTimeout(() => y === scrollY ? r(true) : still(), 100); }}; still(); }}).then(() => scrollTo(0, {scroll}))")
        page.run(Every_page_on_every_screen.DRAWN)
        self.assertEqual(page.run(self.PIXELS), first, "one finger has turned it")
        fingers("touchStart", (x - 30, y), (x + 30, y))
        for step in (32, 45, 60):
            fingers("touchMove", (x - step, y), (x + step, y))
        fingers("touchEnd")
        self.assertGreater(page.run(self.PIXELS)[0], first[0], "two fingers do not come closer")
        self.assertEqual(page.run("[scrollY, visualViewport.scale]"), [scroll, 1])

    def test_cuts_the_surfaces_where_the_reader_wants(self):
        page = self.open(self.directory / "report.html", part="#strain=0.4")
        page.run(Every_page_on_every_screen.DRAWN)
        whole = page.run(self.PIXELS)
        change = "(() => { const s = document.querySelector(%r); s.value = %r; s.dispatchEvent(new Event(%r)); })()"
        page.run(change % ("select[aria-label='Cut']", "2", "change"))
        page.run(change % ("input[aria-label='Place of the cut']", "1", "input"))
        self.assertAlmostEqual(page.run(self.PIXELS)[0], whole[0], delta=200)  # the cell and the rim of a plane in front of it
        self.assertIn("z = ", page.run("document.querySelector('input[aria-label=\"Place of the cut\"]').getAttribute('aria-valuetext')"))
        page.run(change % ("input[aria-label='Place of the cut']", "0.5", "input"))
        half = page.run(self.PIXELS)
        self.assertNotEqual(half[1], whole[1])  # open: the inside of the far half
        page.run(change % ("input[aria-label='Place of the cut']", "0", "input"))
        self.assertLess(page.run(self.PIXELS)[0], 0.6 * whole[0])  # the box alone
        page.run(change % ("select[aria-label='Cut']", "", "change"))
        self.assertEqual(page.run(self.PIXELS), whole)

    def test_marks_where_a_run_diverged(self):
        begin, rest = (self.directory / "report.html").read_text().split('<script type="application/json" id="data">', 1)
        data, end = rest.split("</script>", 1)
        data = json.loads(data)
        data["summary"].update(status="diverged", failure={"reason": "mach", "step": data["step"][-1], "strain": 0.4, "time_s": 1, "value": 1, "limit": 0.3,
                               "place_m": [length / 2e6 for length in data["domain"]["size_um"]], "cell": None})
        (self.directory / "diverged.html").write_text(f'{begin}<script type="application/json" id="data">{json.dumps(data)}</script>{end}')
        page = self.open(self.directory / "diverged.html")
        page.run(Every_page_on_every_screen.DRAWN)
        ring = """(() => { const c = document.querySelector("canvas.over"), fine = c.width / c.clientWidth; return [...c.getContext("2d").getImageData(Math.round(c.width / 2 + 11 * fine), c.height >> 1, 1, 1).data]; })()"""
        self.assertEqual(page.run(f"{ring}.map((v, i) => v - [...rgbOf(css('--bad')).map(v => 255 * v), 255][i])"), [0, 0, 0, 0])
        self.assertIn("the red ring marks the place", page.run("document.querySelector('main').textContent"))
        self.assert_sound(page)
        page.run("timeline.seek(0)")
        self.assertEqual(page.run(ring), [0, 0, 0, 0])

    def test_fills_what_is_cut(self):
        for scheme in ("light", "dark"):
            page = self.open(self.directory / "report.html", scheme=scheme, part="#strain=0.4")
            page.run(Every_page_on_every_screen.DRAWN)
            page.run("(() => { const s = document.querySelector('select[aria-label=Cut]'); s.value = '2'; s.dispatchEvent(new Event('change')); })()")
            # The cell lies in the middle of the box, which is in the middle of the picture.
            seen, wanted = page.run("""(() => { const c = document.querySelector("canvas.space"), gl = c.getContext("webgl2") ?? c.getContext("webgl"), p = new Uint8Array(4);
                gl.readPixels(c.width >> 1, c.height >> 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, p); return [[...p].slice(0, 3), rgbOf(css("--cut")).map(v => 255 * v)]; })()""")
            for a, b in zip(seen, wanted):
                self.assertAlmostEqual(a, b, delta=2)

    def test_has_a_section_that_is_one_plane(self):
        """At the start the cell is a sphere: what a plane cuts of it is a circle of a known radius, or nothing. The triangles lie within the
        sphere, by edge^2 / (6 radius) at the most, in the middle of the largest."""
        page = self.open(self.directory / "report.html")
        page.run("timeline.seek(0)")
        centre, radius, edge = page.run("""(() => { const {surfaces} = timeline.animation.section, nodes = surfaces.at(0), t = surfaces.triangles, n = nodes.length / 3, c = [0, 1, 2].map(k => nodes.filter((_, i) => i % 3 === k).reduce((a, b) => a + b) / n);
            const edges = [...t].map((a, i) => { const b = t[i % 3 === 2 ? i - 2 : i + 1]; return Math.hypot(...[0, 1, 2].map(k => nodes[3 * a + k] - nodes[3 * b + k])); });
            return [c, Math.hypot(nodes[0] - c[0], nodes[1] - c[1], nodes[2] - c[2]), Math.max(...edges)]; })()""")
        for height in (-0.8, 0, 0.5, 1.1):
            page.run(f"timeline.animation.section.z = {centre[2] + height * radius}")
            shapes = page.run("timeline.animation.shapes()[0].map(line => [...line.xy])")
            self.assertEqual(len(shapes), 0 if abs(height) > 1 else 1)
            for line in shapes:
                x, y = line[::2], line[1::2]
                area = abs(sum(a * d - b * c for a, b, c, d in zip(x, y, x[1:] + x[:1], y[1:] + y[:1]))) / 2
                circle = [3.141592653589793 * (r ** 2 - (height * radius) ** 2) for r in (radius - edge ** 2 / (6 * radius), radius * 1.0001)]
                self.assertTrue(circle[0] <= area <= circle[1], (height, area, circle))
        page.run(Every_page_on_every_screen.DRAWN)
        framed = page.run(self.PIXELS)
        page.run("(() => { const s = document.querySelector('input[aria-label=\"Place of the section\"]'); s.value = 0; s.dispatchEvent(new Event('input')); })()")
        self.assertEqual(page.run("timeline.animation.shapes()[0].length"), 0)
        self.assertNotEqual(page.run(self.PIXELS), framed, "the frame in the box does not follow the section")
        self.assert_sound(page)

    def test_makes_a_figure_with_a_bar_and_a_caption(self):
        page = self.open(self.directory / "report.html", scheme="dark", part="#strain=0.4")
        page.run("window.files = []; download = async (name, blob) => files.push([name, [...new Uint8Array(await blob.arrayBuffer())]]); null")
        for kind in ("PDF", "PNG"):
            page.run(f"[...document.querySelectorAll('.menu button')].find(b => b.textContent === 'Figure, {kind}').click()")
        page.wait("files.length === 2")
        files = {Path(name).suffix: bytes(content) for name, content in page.run("files")}
        pdf = files[".pdf"]
        table = int(re.search(rb"startxref\n(\d+)", pdf)[1])
        self.assertTrue(pdf.startswith(b"%PDF-1.4") and pdf[table:].startswith(b"xref"))
        for number, place in enumerate(re.findall(rb"(\d{10}) 00000 n", pdf)):
            self.assertTrue(pdf[int(place):].startswith(f"{number + 1} 0 obj".encode()))
        for part in (b"DCTDecode", b"A spherical capsule in shear", b"strain 0.4", b"Membrane tension, \xb5N/m", b"Computed with Rouleau", b"\xb5m) Tj"):
            self.assertIn(part, pdf)
        self.assertEqual(int.from_bytes(files[".png"][16:20], "big"), 3 * 720)
        self.assertFalse(page.run("document.documentElement.classList.contains('paper') || printing"))
        self.assert_sound(page)

    def test_lies_beside_another_one_and_turns_with_it(self):
        rouleau("report", "--compare", self.directory, self.directory, "--out", folder / "spaces.html")
        page = self.open(folder / "spaces.html")
        page.run(Every_page_on_every_screen.DRAWN)
        pixels = self.PIXELS.replace('document.querySelector("canvas.space")', "document.querySelectorAll('canvas.space')[1]")
        before = page.run(pixels)
        page.run("document.querySelector('canvas.space').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}))")
        self.assertNotEqual(page.run(pixels), before)
        self.assert_sound(page, SCREENS["desktop"]["width"])

    def test_colours_one_cell_by_its_tension(self):
        page = self.open(self.directory / "report.html", part="#strain=0.4")
        page.run(Every_page_on_every_screen.DRAWN)
        self.assertEqual(page.run("[...document.querySelector(\"select[aria-label='Cells by']\").options].map(o => o.text).filter(t => t === 'aggregate')"), [])
        tense = page.run(self.PIXELS)
        page.run("(() => { const s = document.querySelector(\"select[aria-label='Cells by']\"); if (s.value !== 'tension') throw s.value; s.value = 'grey'; s.dispatchEvent(new Event('change')); })()")
        grey = page.run(self.PIXELS)
        self.assertEqual(grey[0], tense[0])
        self.assertNotEqual(grey[1], tense[1])

    def test_carries_what_draws_them_alone(self):
        self.assertIn("var ogl=", (self.directory / "report.html").read_text())
        self.assertNotIn("var ogl=", (folder / "a/report.html").read_text())
        self.assertLess((self.directory / "report.html").stat().st_size, LARGEST_PAGE)


class Walls_that_are_no_planes(PageCase):
    """A post in the middle of a flow, in the plane; a tube, in space."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser(draws_space=True)
        scene = {"rouleau": 1, "title": "a post", "domain": {"size": ["32 um", "16 um"], "nodes": [64, 32], "y": "periodic", "obstacles": [{"sphere": {"center": ["16 um", "8 um"], "radius": "4 um"}}]},
                 "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"}, "numerics": {"density_factor": 100},
                 "cell_types": {"c": {"shape": {"circle": {"radius": "2 um"}}, "segments": 24, "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "1e-5 N/m"}}]}},
                 "cells": [{"type": "c", "at": ["4 um", "8 um"]}],
                 "stages": [{"name": "flow", "duration": "1 ms", "pressure_gradient": "1e5 Pa/m"}],
                 "output": {"cells": {"seconds": "0.2 ms"}, "fields": {"seconds": "0.5 ms", "quantities": ["velocity"]}}}
        (folder / "post.json").write_text(json.dumps(scene))
        rouleau("run", folder / "post.json", "--out", folder / "post", "--quiet")
        rouleau("run", SOURCE / "tests/physics/scenes/capsule-in-tube.json", "--out", folder / "tube", "--quiet", "--set", "/stages/0/duration=\"0.5 ms\"",
                "--set", '/domain/walls/tube/radius="2.5 um"')
        rouleau("report", "--compare", folder / "post", folder / "post", "--out", folder / "posts.html")

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()

    def colour(self, page, x, y):
        """At a place in um of the first animation."""
        return page.run(f"""(() => {{ const c = document.querySelector('canvas.view:not(.space)'), {{size_um: [lx, ly], periodic: [, open]}} = (data.runs?.[0] ?? data).domain, fine = c.width / c.clientWidth;
            const scale = Math.min((c.clientWidth - 14) / lx, (c.clientHeight - (open ? 14 : 40)) / ly), px = c.clientWidth / 2 + ({x} - lx / 2) * scale, py = c.clientHeight / 2 - ({y} - ly / 2) * scale;
            const one = Object.assign(document.createElement('canvas'), {{width: 1, height: 1}}).getContext('2d', {{willReadFrequently: true}});
            one.drawImage(c, -Math.round(fine * px), -Math.round(fine * py));
            return [...one.getImageData(0, 0, 1, 1).data].slice(0, 3); }})()""")

    def tone(self, page, name):
        return page.run(f"(() => {{ const c = document.createElement('canvas').getContext('2d'); c.fillStyle = css('{name}'); c.fillRect(0, 0, 1, 1); return [...c.getImageData(0, 0, 1, 1).data].slice(0, 3); }})()")

    def test_are_filled_and_not_fluid_at_rest(self):
        flow = "(v => { const s = document.querySelector('select[aria-label=Flow]'); s.value = v; s.dispatchEvent(new Event('change')); })"
        for file in ("post/report.html", "posts.html"):
            for scheme in ("light", "dark"):
                with self.subTest(file=file, scheme=scheme):
                    page = self.open(folder / file, scheme=scheme)
                    page.run("timeline.seek(timeline.count - 1)")
                    for quantity in ("", "speed"):
                        page.run(f"{flow}('{quantity}')")
                        page.run(Every_page_on_every_screen.DRAWN)
                        for x, y in ((16, 8), (13.2, 8), (16, 11.2)):
                            self.assertEqual(self.colour(page, x, y), self.tone(page, "--wall"))
                    page.run("document.querySelector('input[type=checkbox]').click()")  # without tracers
                    for x, y in ((16, 14), (24, 8), (16, 2)):
                        self.assertNotEqual(self.colour(page, x, y), self.tone(page, "--wall"))
                    self.assert_sound(page, SCREENS["desktop"]["width"])

    def test_have_no_line_where_the_domain_ends(self):
        page = self.open(folder / "tube" / "report.html")
        sides = page.run("data.walls.segments.map(pair => pair.map(c => data.walls.corners_um[2 * c + 1]))")
        self.assertEqual(sorted(sides), [[0.5, 0.5], [5.5, 5.5]])  # of two rectangles, one side each
        self.assertEqual(self.colour(page, 2, 5.8), self.tone(page, "--wall"))
        self.assert_sound(page)

    def test_are_glass_in_three_dimensions_that_a_cut_opens(self):
        pixels = The_page_of_a_run_in_three_dimensions.PIXELS
        for scheme in ("light", "dark"):
            page = self.open(folder / "tube" / "report.html", scheme=scheme)
            page.run("timeline.seek(0)")
            page.run(Every_page_on_every_screen.DRAWN)
            whole = page.run(pixels)
            self.assertGreater(whole[0], 30000)  # the tube, where cell and box alone have far fewer
            change = "(() => { const s = document.querySelector(%r); s.value = %r; s.dispatchEvent(new Event(%r)); })()"
            page.run(change % ("select[aria-label='Cut']", "2", "change"))
            self.assertNotEqual(page.run(pixels)[1], whole[1])
            page.run(change % ("input[aria-label='Place of the cut']", "0", "input"))
            self.assertLess(page.run(pixels)[0], 0.3 * whole[0])
            self.assert_sound(page)


class A_tube(PageCase):
    """Plasma whose flow has developed."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser(draws_space=True)
        rouleau("run", SOURCE / "scenes/tube-3d.json", "--out", folder / "plasma", "--quiet", "--max-steps", "8", "--set", '/stages/0/start="developed"',
                "--set", '/output/fields={"seconds": 1e-6, "quantities": ["velocity"]}', "--set", '/output/cells={"seconds": 1e-6}')

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()

    def test_has_the_profile_of_poiseuille(self):
        page = self.open(folder / "plasma" / "report.html")
        places, profile = page.run("(() => { const flow = timeline.across, u = flow.profile(flow.between); return [[...flow.places(u.length)], [...u]]; })()")
        for y, u in zip(places, profile):  # G / (4 viscosity) (R^2 - r^2), um/s
            self.assertAlmostEqual(u, 1e4 / (4 * 1.2e-3) * 1e-6 * max(0, 100 - (y - 10) ** 2), delta=0.02 * 1e4 / (4 * 1.2e-3) * 1e-4)
        self.assertEqual(page.run("document.querySelectorAll('canvas.space, canvas.across').length"), 2)
        self.assert_sound(page, SCREENS["desktop"]["width"])


class The_foot_of_a_page(PageCase):
    def test_says_what_made_it_how_to_cite_it_and_how_to_make_it_again(self):
        version = rouleau("--version").stdout.split()[1]
        for file, command in (("a/report.html", "rouleau run scene.json"), ("both.html", "rouleau report --compare a b")):
            page = self.open(folder / file)
            words = page.run("document.querySelector('footer').textContent")
            for part in (f"Rouleau {version}", "@software{rouleau", command):
                self.assertIn(part, words)
            for place in (str(folder), str(SOURCE), str(PLUGINS)):
                self.assertNotIn(place, (folder / file).read_text())
            self.assert_sound(page)
        page = self.open(folder / "a/report.html")
        page.run("window.files = []; download = async (name, blob) => files.push([name, await blob.text()]); [...document.querySelectorAll('footer button')].find(b => b.textContent === 'Save scene.json').click()")
        page.wait("files.length > 0")
        self.assertEqual(page.run("files[0]"), ["scene.json", (folder / "a/scene.json").read_text()])


class Two_runs(PageCase):
    def test_move_together_and_what_differs_stands_below(self):
        page = self.open(folder / "both.html")
        strains = page.run("timeline.instants.map((_, p) => data.runs.map((run, r) => run.strain[timeline.output(r, p)]))")
        for a, b in strains:
            self.assertAlmostEqual(a, b, delta=0.01)
        self.assertAlmostEqual(strains[-1][0], 1, delta=0.01)
        text = page.run("document.querySelector('main').textContent")
        self.assertIn("/interactions/0/parameters/depth", text)
        self.assertIn("/stages/1/shear_rate", text)
        self.assertIn("Both runs used the same plugins, byte for byte.", text)
        self.assertIn("Dimensionless, adhesion number", text)
        self.assert_sound(page)

    def test_have_one_scale_of_colours(self):
        page = self.open(folder / "both.html")
        scales = page.run("data.runs.map(run => run.outlines.tension.scale_N_per_m)")
        self.assertNotEqual(*scales)
        one, other = page.run("data.runs.map(run => cellColours(run, data.runs)).map(({tension, speed, deformation}) => [tension, speed, deformation].map(c => c.scale.ends))")
        self.assertEqual(one, other)
        self.assertEqual(*page.run(f"data.runs.map(run => cellColours(run, data.runs).tension.tension({min(scales) / 2} / run.outlines.tension.scale_N_per_m))"))
        page.run("(() => { const s = document.querySelector(\"select[aria-label='Cells by']\"); s.value = 'tension'; s.dispatchEvent(new Event('change')); })()")
        one, other = page.run("[...document.querySelectorAll('.bar.cells')].map(bar => bar.textContent)")
        self.assertIn("Membrane tension", one)
        self.assertEqual(one, other)

    def test_are_compared_over_the_time_where_that_is_chosen(self):
        page = self.open(folder / "both.html")
        self.assertEqual(page.run("[...document.querySelector('select[aria-label=\"Horizontal axis\"]').options].map(o => o.value)"), ["strain", "time_s"])
        page.run("timeline.seek(timeline.count - 1)")
        page.run(f"{OVER}('time_s')")
        last = page.run("Math.max(...data.runs.map(run => run.time_s.at(-1)))")
        page.wait(f"charts.every(c => Math.abs(c.u.scales.x.max - {last}) <= 1e-9 * {last})")
        slider = page.run("Number(document.querySelector('input[type=range]').max)")
        self.assertEqual(slider, page.run("timeline.count - 1"))
        for time, *outputs in page.run("timeline.instants.map((k, p) => [timeline.place(p), ...data.runs.map((run, r) => run.time_s[timeline.output(r, p)])])"):
            for r, at in enumerate(outputs):
                self.assertAlmostEqual(at, min(page.run(f"data.runs[{r}].time_s"), key=lambda t: abs(t - time)), delta=1e-9)
        self.assertIn("All show the same time", page.run("document.querySelector('main').textContent"))
        page.run(f"{OVER}('strain')")
        page.wait("charts.every(c => c.u.scales.x.max < 1.1)")
        self.assert_sound(page)

    def test_are_compared_by_what_is_more_than_rounding_and_errors(self):
        page = self.open(folder / "both.html")
        self.assertEqual(page.run("[...document.querySelectorAll('summary')].filter(s => s.textContent === 'Numerics, cost and machine').length"), 1)
        rows = page.run("""(() => {
            const run = (viscosity, noise, error) => ({summary: {error_bars: {relative_viscosity: {error}}, rheology: [{stage: "rest", means: {}}, {stage: "shear", means: {}}]}}), mean = (name, ...values) => ({name: `mean/${name}`, values, differs: true});
            showOutcome({runs: [run(0, 0, .02), run(0, 0, .01)], differences: {outcome: [mean("shear/relative_viscosity", 1.5, 1.52), mean("shear/wall_stress_lower_Pa", .1, .2), mean("rest/wall_stress_lower_Pa", 1e-15, 3e-15),
                mean("shear/particle_stress_Pa", 1e-9, 2), {name: "steps", values: [10, 20], differs: true}]}});
            return [...document.querySelectorAll("#outcome")].at(-1).nextElementSibling.innerText.split("\\n").map(line => line.split("\\t")); })()""")
        self.assertEqual(rows[1:], [["Mean, shear, relative viscosity", "1.50 ± 0.02", "1.520 ± 0.010", "within the errors"], ["Mean, shear, wall stress lower, Pa", "0.1", "0.2", "100 %"],
                                    ["Mean, shear, particle stress, Pa", "≈ 0", "2", ""]])

    def test_that_are_the_same_do_not_differ(self):
        rouleau("report", "--compare", folder / "a", folder / "a", "--out", folder / "same.html")
        page = self.open(folder / "same.html")
        text = page.run("document.querySelector('main').textContent")
        for words in ("Both runs have the same scene.", "All numbers are the same."):
            self.assertIn(words, text)
        self.assert_sound(page)


class A_page_with_a_fault(PageCase):
    """What the other tests look for is found where it is."""

    FAULTS = {"exception": "setTimeout(() => { throw new Error('x'); })", "console": "console.error('x')",
              "request": "new Image().src = 'http://127.0.0.1:9/x.png'",
              "wide": "document.querySelector('main').append(Object.assign(document.createElement('div'), {style: 'width:500px;height:5px'}))"}

    def test_is_found_out(self):
        text = (folder / "a/report.html").read_text()
        for name, script in self.FAULTS.items():
            with self.subTest(name):
                file = folder / f"{name}.html"
                file.write_text(text.replace("</body>", f"<script>{script}</script></body>"))
                page = self.open(file, "phone")
                if name == "wide":
                    self.assertGreater(page.run("document.scrollingElement.scrollWidth"), 390)
                    continue
                page.until(lambda: any(fault.startswith(name) for fault in page.faults()), f"a fault: {name}")


if __name__ == "__main__":
    main()

"""What the pages of runs do under mouse and keys, what can be saved from them, and whether every reader can use them. Needs
chromium and pandas.

usage: check_interactions.py ROULEAU PLUGIN_FOLDER SOURCE_FOLDER
"""
import itertools
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from browser import Browser, BrowserCase, main
from readers import EYES, contrast, difference, lab, obstacles

PROGRAM, PLUGINS, SOURCE = (Path(a).resolve() for a in sys.argv[1:4])
sys.path.insert(0, str(SOURCE / "python"))

import rouleau as package  # noqa: E402

SCENE = SOURCE / "scenes" / "four-cells-shear.json"
SHORT = {"stages": [{"name": "rest", "duration": "5 ms", "density_factor": 13000}, {"name": "shear", "shear_rate": "20 1/s", "strain": 0.3}],
         "output": {"cells": {"seconds": "0.5 ms"}, "fields": {"seconds": "2 ms", "quantities": ["velocity"]}}}
EIGHT = [{"type": "rbc", "row": {"count": 8, "spacing": "6 um", "axis": "x", "angle": "90 deg", "center": ["25 um", "12.5 um"]}}]
# What a rouleau did, for a run that is too short for it.
HISTORY = [("rest", 0, [[0], [1], [2], [3]]), ("rest", 6, [[0, 1, 2, 3]]), ("shear", 14, [[0], [1, 2], [3]]), ("shear", 20, [[0], [1], [2], [3]])]


def rouleau(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, timeout=120, env={**os.environ, "ROULEAU_PLUGIN_PATH": str(PLUGINS)})


def make(name, history=None, **changes):
    scene = folder / f"{name}.json"
    scene.write_text(json.dumps({**json.loads(SCENE.read_text()), **SHORT, **changes}))
    rouleau("run", scene, "--out", folder / name, "--quiet")
    if history:
        run = package.open(folder / name)
        when = run.series[["time_s", "strain"]].to_dict("records")
        events = [{**when[i], "count": len(m), "members": m, "through_image": False} for _, i, m in history]
        (run.directory / "summary.json").write_text(json.dumps({**run.summary, "aggregate_history": events}))
        rouleau("report", folder / name)


def setUpModule():
    global folder, browser
    folder = Path(tempfile.mkdtemp(prefix="rouleau-pages-"))
    make("four", HISTORY)
    make("eight", cells=EIGHT)
    make("stronger", interactions=[{**json.loads(SCENE.read_text())["interactions"][0], "parameters": {"depth": "1.3e-6 J/m2", "zero_force_distance": "0.49 um", "cutoff": "3.52 um"}}])
    rouleau("report", "--compare", folder / "four", folder / "stronger", folder / "eight", "--out", folder / "three.html")
    browser = BrowserCase.browser = Browser()


def tearDownModule():
    browser.__exit__()
    shutil.rmtree(folder, ignore_errors=True)


VIEW = "document.querySelector('canvas.view').toDataURL()"
# The animation of a run's page is found through what draws it.
ANIMATION = "timeline.animation"


class PageOfFour(BrowserCase):
    def four(self, **more):
        page = self.open(folder / "four/report.html", **more)
        page.wait("charts[1].u.status === 1")
        return page

    def tearDown(self):
        self.assertEqual([fault for event_page in self.pages for fault in event_page.faults()], [])

    def setUp(self):
        self.pages = []

    def open(self, *arguments, **more):
        page = super().open(*arguments, **more)
        self.pages.append(page)
        return page

    def cell(self, page, number):
        """Point of the screen in the middle of a cell's left lobe, after scrolling there."""
        return page.run(f"""(() => {{ const a = {ANIMATION}; a.canvas.scrollIntoView({{block: 'center'}}); a.draw(); const box = a.canvas.getBoundingClientRect(), [x, y] = a.centreOf(a.shapes(), {number});
            return [box.left + a.width / 2 + (x - a.middle[0]) * a.scale, box.top + a.height / 2 - (y - a.middle[1]) * a.scale]; }})()""")


class The_result(PageOfFour):
    def test_is_a_sentence_and_four_numbers_beside_what_was_expected(self):
        page = self.four()
        at = page.run("[data.time_s[6], data.strain[14], data.strain[20]]")
        words = page.run("document.querySelector('.came-out').textContent")
        self.assertTrue(words.startswith(f"All 4 cells joined at {at[0]:.3g} s. The aggregate broke at strain {at[1]:.4g}; all cells were single from strain {at[2]:.4g}."), words)
        self.assertEqual(page.run("document.querySelectorAll('.numbers dd').length"), 4)
        self.assertIn("Expected: The four cells gather", page.run("document.querySelector('.expected').textContent"))

    def test_has_numbers_that_lead_to_their_instant(self):
        page = self.four()
        page.run("document.querySelectorAll('.numbers button')[0].click()")
        self.assertEqual(page.run("timeline.position"), 6)

    def test_rounds_a_value_to_its_error(self):
        page = self.four()
        for value, error, words in ((0.34712, 0.0042, "0.347 ± 0.005"), (1.1749, 0.013, "1.175 ± 0.013"), (123.4, 2.1, "123 ± 3"), (-0.5, 0.03, "−0.50 ± 0.03")):
            self.assertEqual(page.run(f"withError({value}, {error})"), words)
        for value, spread, words in ((1.1746, 0.031, "1.17"), (1.2, 0.003, "1.2"), (1.2, 0, "1.2"), (1.02305, 0.0003, "1.02"), (2.36, 0.11, "2.36")):
            self.assertEqual(page.run(f"withError({value}, null, {spread})"), words)


class The_animation(PageOfFour):
    def test_begins_where_the_aggregate_breaks_and_plays_to_the_end_once(self):
        page = self.four(still=False)
        self.assertEqual(page.run("eventsOf(data).filter(e => e.kind === 'break')[0].position"), 14)
        page.wait("timeline.playing")
        self.assertGreaterEqual(page.run("timeline.position"), 14)
        page.wait("!timeline.playing && timeline.position === timeline.count - 1")
        page.run("new Promise(r => setTimeout(r, 400))")
        self.assertFalse(page.run("timeline.playing"))

    def test_stands_still_for_those_who_want_no_motion(self):
        page = self.four()
        page.run("new Promise(r => setTimeout(r, 1300))")
        self.assertEqual(page.run("[timeline.playing, timeline.position]"), [False, 14])

    def test_lies_between_two_outputs_halfway(self):
        page = self.four()
        pictures = []
        for position in (16, 16.5, 17):
            page.run(f"timeline.seek({position})")
            pictures.append(page.run(VIEW))
        self.assertEqual(len(set(pictures)), 3)
        far = page.run("(() => { const o = timeline.animation.outlines, m = o.between({a: 16, b: 17, share: .5}), [p, q] = [o.at(16), o.at(17)]; return Math.max(...m.map((v, i) => Math.abs(v - (p[i] + q[i]) / 2))); })()")
        self.assertLess(far, 1e-5)
        self.assertEqual(page.run("timeline.seek(16), " + VIEW), pictures[0])

    def test_obeys_space_arrows_and_zero_but_not_while_a_control_has_the_focus(self):
        page = self.four()
        page.key(" ")
        page.wait("timeline.playing")
        page.key(" ")
        self.assertFalse(page.run("timeline.playing"))
        page.run("timeline.seek(10)")
        page.key("ArrowRight")
        self.assertEqual(page.run("timeline.position"), 11)
        page.key("ArrowLeft")
        self.assertEqual(page.run("timeline.position"), 10)
        page.run("document.querySelector('select[aria-label=Flow]').focus()")
        page.key(" ")
        self.assertFalse(page.run("timeline.playing"))

    def test_comes_closer_moves_and_goes_back(self):
        page = self.four()
        first = page.run(VIEW)
        page.key("+")
        page.wait(f"{ANIMATION}.zoom > 1.4")
        x, y = self.cell(page, 1)
        centre = page.run(f"{ANIMATION}.middle")
        page.mouse("mousePressed", x, y, button="left", clickCount=1, buttons=1)
        for step in (20, 40):
            page.mouse("mouseMoved", x + step, y + step, button="left", buttons=1)
        page.mouse("mouseReleased", x + 40, y + 40, button="left", clickCount=1)
        moved = page.run(f"{ANIMATION}.middle")
        scale = page.run(f"{ANIMATION}.scale")
        self.assertAlmostEqual(moved[0], centre[0] - 40 / scale, places=3)
        self.assertAlmostEqual(moved[1], centre[1] + 40 / scale, places=3)
        page.key("0")
        page.wait(f"{ANIMATION}.zoom === 1")
        self.assertEqual(page.run(VIEW), first)

    def test_tells_of_the_cell_under_the_pointer_and_lifts_it_in_the_charts_when_clicked(self):
        page = self.four()
        x, y = self.cell(page, 2)
        page.mouse("mouseMoved", x, y)
        page.wait("!document.querySelector('.tip').hidden")
        words = page.run("document.querySelector('.tip').textContent")
        for part in ("cell 2, rbc", "gap", "deformation"):
            self.assertIn(part, words)
        page.click(x, y)
        self.assertEqual(page.run("document.querySelector('select[aria-label=Cell]').value"), "2")
        self.assertEqual(page.run("charts.find(c => c.title.startsWith('Deformation')).lifted"), 3)
        page.click(x, y)
        self.assertEqual(page.run("document.querySelector('select[aria-label=Cell]').value"), "")

    def test_comes_closer_between_two_fingers_and_keeps_there_what_was_there(self):
        page = self.four(screen="phone")
        page.run(f"{ANIMATION}.canvas.scrollIntoView({{block: 'center'}})")
        left, top, width, height, scroll = page.run(f"(() => {{ const r = {ANIMATION}.canvas.getBoundingClientRect(); return [r.left, r.top, r.width, r.height, scrollY]; }})()")
        x, y = width * 0.4, height * 0.6

        def fingers(kind, apart, dy=0):
            page.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": left + x + s * apart, "y": top + y + dy, "id": s + 1} for s in (-1, 1)] if apart else [])

        below = page.run(f"{ANIMATION}.toDomain({x}, {y})")
        fingers("touchStart", 30)
        for apart in (32, 45, 60):
            fingers("touchMove", apart)
        self.assertAlmostEqual(page.run(f"{ANIMATION}.zoom"), 60 / 32, delta=0.05)
        for before, now in zip(below, page.run(f"{ANIMATION}.toDomain({x}, {y})")):
            self.assertAlmostEqual(before, now, delta=0.05)
        fingers("touchMove", 60, 20)  # both fingers move: the picture goes with them
        for before, now in zip(below, page.run(f"{ANIMATION}.toDomain({x}, {y + 20})")):
            self.assertAlmostEqual(before, now, delta=0.05)
        fingers("touchEnd", 0)
        self.assertEqual(page.run("[scrollY, visualViewport.scale, timeline.animation.view.cell]"), [scroll, 1, None])

    def test_is_drawn_in_every_frame_of_the_screen_and_leaves_it_most_of_its_time(self):
        page = self.four()
        frames, draws, script, gap = page.run("""(async () => {
            const a = timeline.animation, draw = a.draw.bind(a), seek = timeline.seek.bind(timeline), times = [], gaps = [];
            let draws = 0, on = true, last = null;
            a.draw = () => { ++draws; draw(); };
            timeline.seek = position => { const begin = performance.now(); seek(position); times.push(performance.now() - begin); };
            const tick = stamp => { if (last !== null) gaps.push(stamp - last); last = stamp; if (on) requestAnimationFrame(tick); };
            timeline.seek(0); draws = 0; times.length = 0;
            timeline.play(() => 0.2); requestAnimationFrame(tick);
            await new Promise(r => setTimeout(r, 1500));
            on = false; timeline.stop();
            const median = list => list.sort((p, q) => p - q)[list.length >> 1];
            return [gaps.length + 1, draws, median(times), median(gaps)]; })()""")
        print(f"{1000 / gap:.0f} frames/s in the median, {script:.2f} ms of script in each")
        self.assertLessEqual(abs(frames - draws), 2)
        self.assertGreater(frames, 4)
        self.assertLess(script, 1000 / 60 / 2)

    def test_keeps_the_cell_that_it_follows_in_the_middle(self):
        page = self.four()
        page.run("document.querySelector('select[aria-label=Cell]').value = '3'; document.querySelector('select[aria-label=Cell]').dispatchEvent(new Event('change'))")
        page.run("[...document.querySelectorAll('label')].find(l => l.textContent === 'Follow').querySelector('input').click()")
        for position in (2, 18):
            page.run(f"timeline.seek({position})")
            self.assertAlmostEqual(*page.run(f"[{ANIMATION}.middle[0], {ANIMATION}.centreOf({ANIMATION}.shapes(), 3)[0]]"), places=4)

    def test_colours_cells_in_every_way_and_greys_them_over_a_field(self):
        page = self.four()
        choose = "((label, v) => { const s = document.querySelector(`select[aria-label=\"${label}\"]`); s.value = v; s.dispatchEvent(new Event('change')); return s.value; })"
        page.run("timeline.seek(18)")
        pictures = {}
        for colour in ("aggregate", "type", "tension", "deformation", "speed", "grey"):
            self.assertEqual(page.run(f"{choose}('Cells by', '{colour}')"), colour)
            pictures[colour] = page.run(VIEW)
            if colour in ("tension", "deformation", "speed"):
                self.assertTrue(page.run("!!document.querySelector('.bar.cells .ramp')"), colour)
        self.assertGreaterEqual(len(set(pictures.values())), 5)
        page.run(f"{choose}('Cells by', 'aggregate')")
        page.run(f"{choose}('Flow', 'speed')")
        self.assertEqual(page.run("document.querySelector('select[aria-label=\"Cells by\"]').value"), "grey")
        page.run(f"{choose}('Flow', '')")
        self.assertEqual(page.run("document.querySelector('select[aria-label=\"Cells by\"]').value"), "aggregate")

    def test_has_tracers_that_go_with_the_flow_and_arrows_on_walls_that_move(self):
        page = self.four()
        page.run("timeline.seek(20)")
        rate, height = page.run(f"[data.shear_rate[20], {ANIMATION}.ly]")
        for share in (0.05, 0.3, 0.97):  # the speed of the tracers is that of the field
            speed, tracer, most = page.run(f"""(() => {{ const a = {ANIMATION}, f = a.data.fields, q = f.quantities[0], k = 1, y = {share}, j = Math.floor(y * f.ny), [u, v] = a.fields.velocity({{a: k, b: k, share: 0}})(f.box_um[2] / f.nx / 2, (j + .5) / f.ny * a.ly);
                return [q.scale * 1e6 * bytesOf(q.values[k])[j * f.nx] / 254, Math.hypot(u, v), f.velocity.scale * 1e6]; }})()""")
            self.assertAlmostEqual(speed / most, tracer / most, delta=0.02)
        u = page.run(f"(() => {{ const a = {ANIMATION}; return a.fields.velocity(a.fields.between(a.between))(2, a.ly * .99); }})()")[0]
        self.assertTrue(0.3 < u / (rate * height / 2) < 1, u)
        self.assertEqual([round(s) for s in page.run(f"wallMotion({ANIMATION}).map(wall => wall.speed)")], [round(-rate * height / 2), round(rate * height / 2)])
        page.run("timeline.seek(5)")
        self.assertEqual(page.run(f"wallMotion({ANIMATION}).map(wall => wall.speed)"), [0, 0])
        moving = page.run("timeline.seek(20), " + VIEW)
        page.run("[...document.querySelectorAll('label')].find(l => l.textContent === 'Tracers').querySelector('input').click()")
        self.assertNotEqual(page.run(VIEW), moving)


class Events(PageOfFour):
    def test_are_buttons_below_the_slider_and_ticks_on_every_chart_that_lead_there(self):
        page = self.four()
        for position, kind in ((6, "join"), (14, "break"), (20, "break")):
            self.assertIn([position, kind], page.run("eventsOf(data).map(e => [e.position, e.kind])"))
        self.assertEqual(page.run("charts.filter(c => !c.folded).map(c => c.u.over.querySelectorAll('.event').length)"), [4] * 4)
        page.run("document.querySelector('.story button.join').click()")
        self.assertEqual(page.run("timeline.position"), 6)
        page.run("charts[0].u.over.querySelectorAll('.event.break')[0].scrollIntoView({block: 'center'})")
        page.click(*page.run("(() => { const r = charts[0].u.over.querySelectorAll('.event.break')[0].getBoundingClientRect(); return [r.left + r.width / 2, r.top + r.height / 2]; })()"))
        self.assertEqual(page.run("timeline.position"), 14)

    def test_leave_out_what_was_undone_at_once(self):
        page = self.four()
        count = page.run("""(() => { const h = data.summary.aggregate_history, at = i => data.time_s[i]; const [a, b] = [h[2].members, h[3].members];
            return lastingHistory({...data, summary: {aggregate_history: [...h, {...h[2], time_s: at(22)}, {...h[3], time_s: at(23)}]}}).length; })()""")
        self.assertEqual(count, 4)


class Charts(PageOfFour):
    def test_are_four_until_the_others_are_asked_for(self):
        page = self.four()
        self.assertEqual(page.run("charts.filter(c => !c.folded).length"), 4)
        page.run("document.querySelectorAll('.folded').forEach(d => { d.open = true; })")
        page.wait("charts.every(c => !c.folded && c.width > 300)")

    def test_show_a_stage_at_rest_and_one_in_shear_each_in_its_measure(self):
        page = self.four()
        self.assertEqual(page.run("timeline.over"), "stages")
        ticks = page.run("stageTicks(timeline, 0, timeline.count - 1, 500)")
        last = page.run("timeline.stages[0].to")
        self.assertTrue(all(t["text"].endswith(" s") for t in ticks if t["at"] <= last) and any(t["at"] <= last for t in ticks))
        for tick in (t for t in ticks if t["at"] > last):
            low, high = page.run(f"[data.strain[{math.floor(tick['at'])}], data.strain[{math.ceil(tick['at'])}]]")
            self.assertTrue(low - 1e-6 <= float(tick["text"]) <= high + 1e-6, tick)

    def test_leave_a_spike_outside_until_it_is_asked_for(self):
        page = self.four()
        usual = page.run("usualRange([{values: [4110, ...Array.from({length: 40}, (_, i) => 1 + i / 100)]}])")
        self.assertLess(usual[1], 2)
        self.assertIsNone(page.run("usualRange([{values: Array.from({length: 40}, (_, i) => i)}])"))

    def test_of_many_cells_show_median_and_spread_and_the_cell_that_was_chosen(self):
        page = self.open(folder / "eight/report.html")
        page.wait("charts[1].u.status === 1")
        chart = "charts.find(c => c.title.startsWith('Deformation'))"
        self.assertEqual(page.run(f"{chart}.lines.map(l => l.label)"), ["median", "middle 80 %", ""])
        page.run("document.querySelector('select[aria-label=Cell]').value = '5'; document.querySelector('select[aria-label=Cell]').dispatchEvent(new Event('change'))")
        self.assertEqual(page.run(f"{chart}.lines[2].label"), "cell 5")
        self.assertEqual(page.run(f"{chart}.u.data[4][10]"), page.run("data.cells.deformation[5][10]"))
        page.run("timeline.animation.view.choose(5)")  # none any more
        x, y = self.cell(page, 2)
        page.mouse("mouseMoved", x, y)
        self.assertEqual(page.run(f"{chart}.lines[2].label"), "cell 2")
        page.mouse("mouseMoved", x, page.run(f"{ANIMATION}.canvas.getBoundingClientRect().top - 30"))
        self.assertEqual(page.run(f"{chart}.lines[2].label"), "")


class What_is_saved(PageOfFour):
    def saved(self, page, expression):
        """The files, {name, text or size}, that an expression hands to the reader."""
        page.run("window.files = []; download = async (name, blob) => files.push({name, type: blob.type, size: blob.size, text: blob.type.startsWith('image/png') || blob.type.startsWith('video') ? null : await blob.text()}); null")
        page.run(expression)
        page.wait("files.length > 0")
        return page.run("files")

    def press(self, where, text):
        return f"[...{where}.querySelectorAll('.menu button')].find(b => b.textContent === '{text}').click()"

    def test_is_the_picture_as_png_and_svg(self):
        page = self.four()
        png, = self.saved(page, self.press("document.querySelector('.stage')", "Picture, PNG"))
        self.assertTrue(png["name"].endswith(".png") and png["size"] > 5000, png)
        page.run("(() => { const s = document.querySelector('select[aria-label=Flow]'); s.value = 'vorticity'; s.dispatchEvent(new Event('change')); })()")
        svg, = self.saved(page, self.press("document.querySelector('.stage')", "Picture, SVG"))
        root = ElementTree.fromstring(svg["text"])
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        self.assertGreater(len(root.findall(".//{*}path")), 20)
        self.assertEqual(len(root.findall(".//{*}image")) > 0, True)

    def test_is_a_chart_as_csv_svg_and_png(self):
        page = self.four()
        chart = "charts.find(c => c.title.startsWith('Deformation')).plot.parentNode"
        csv, = self.saved(page, self.press(chart, "CSV"))
        lines = csv["text"].splitlines()
        self.assertEqual(lines[0], "time_s,strain,cell 0,cell 1,cell 2,cell 3")
        self.assertEqual(len(lines), 1 + page.run("data.step.length"))
        self.assertEqual(float(lines[4].split(",")[3]), page.run("data.cells.deformation[1][3]"))
        svg, = self.saved(page, self.press(chart, "SVG"))
        words = [t.text for t in ElementTree.fromstring(svg["text"]).findall(".//{*}text")]
        self.assertIn("cell 3", words)
        png, = self.saved(page, self.press(chart, "PNG"))
        self.assertGreater(png["size"], 3000)

    def test_is_a_video_in_what_the_browser_can_record(self):
        page = self.four()
        size, kind, ending = page.run("recordVideo(timeline, timeline.animation, {from: timeline.count - 7}).then(v => [v.blob.size, v.blob.type, v.ending])")
        self.assertGreater(size, 2000)
        self.assertEqual(kind, f"video/{ending}")

    def test_is_a_link_to_the_instant(self):
        page = self.four()
        page.run("timeline.seek(18)")
        page.run("[...document.querySelectorAll('button')].find(b => b.textContent === 'Copy link').click()")
        part = page.run("location.hash")
        self.assertTrue(part.startswith("#strain="), part)
        self.assertEqual(self.four(part=part).run("timeline.position"), 18)
        time = page.run("data.time_s[3]")
        self.assertEqual(self.four(part=f"#time={time}").run("timeline.position"), 3)
        self.assertEqual(self.four(part="#cells").run("timeline.position"), 14)


    def test_has_a_figure_of_which_nothing_lies_off_its_page(self):
        page = self.four()
        page.run("timeline.seek(16)")
        pdf = bytes(page.run("[...figurePdf(timeline.animation)]"))
        width, height = map(float, re.search(rb"MediaBox\[0 0 ([\d.]+) ([\d.]+)\]", pdf).groups())
        places = [(float(x), float(y)) for x, y in re.findall(rb"(-?[\d.]+) (-?[\d.]+) [ml]\b", pdf)]
        self.assertGreater(len(places), 200)  # the outlines
        self.assertTrue(all(0 <= y <= height for _, y in places))
        drawn = [y for _, y in places if 0 < y < height]  # all but the ground
        low, high = min(drawn), max(drawn)  # the walls, with room below for the caption
        self.assertGreater(low, height - high)
        self.assertIn(b"Computed with Rouleau", pdf)


class Tables(PageOfFour):
    def test_are_in_tabs_that_keys_go_through(self):
        page = self.four()
        shown = "[...document.querySelectorAll('[role=tabpanel]')].filter(p => p.offsetParent).map(p => p.ariaLabel)"
        self.assertEqual(page.run(shown), ["Result"])
        page.run("document.querySelector('[role=tab]').focus()")
        page.key("ArrowRight")
        self.assertEqual(page.run(shown), ["Physics"])
        self.assertEqual(page.run("document.activeElement.textContent"), "Physics")
        page.run("document.querySelectorAll('[role=tab]')[3].click()")
        self.assertEqual(page.run(shown), ["Provenance"])
        page.media("light", "print")
        self.assertEqual(len(page.run(shown)), 4)

    def test_of_three_runs_can_be_sorted_and_their_heads_name_what_differs(self):
        page = self.open(folder / "three.html")
        heads = page.run("[...document.querySelectorAll('.status .run-name strong')].map(e => e.textContent)")
        self.assertIn("depth 5.2e-8 J/m2", heads[0])
        self.assertIn("depth 1.3e-6 J/m2", heads[1])
        order = "[...document.querySelector('#runs').nextElementSibling.querySelectorAll('tbody tr')].map(tr => tr.firstChild.textContent)"
        self.assertEqual(page.run(order), ["A", "B", "C"])
        page.run("[...document.querySelectorAll('.sortable th button')].find(b => b.textContent === 'Run').click()")
        page.run("[...document.querySelectorAll('.sortable th button')].find(b => b.textContent === 'Run').click()")
        self.assertEqual(page.run(order), ["C", "B", "A"])


class Every_reader(PageOfFour):
    def test_can_tell_any_two_colours_of_lines_and_cells_apart(self):
        for scheme in ("light", "dark"):
            page = self.four(scheme=scheme)
            tones = page.run("[...lineTones, '--single'].map(css)")
            for (a, b), eye in itertools.product(itertools.combinations(tones, 2), EYES):
                self.assertGreater(difference(a, b, eye), 20, (scheme, a, b, eye))
            for tone in tones:
                self.assertGreaterEqual(contrast(tone, page.run("css('--card')")), 3, (scheme, tone))

    def test_can_read_every_scale_of_colours(self):
        """One that has no sign goes from dark to light or back; the two ends of one that has a sign look different."""
        for scheme in ("light", "dark"):
            scales = self.four(scheme=scheme).run("({...ramps[isDark() ? 'dark' : 'light'], ...rampStops})")
            self.assertEqual(set(scales), {"speed", "vorticity", "cividis", "tension"})
            for (name, stops), eye in itertools.product(scales.items(), EYES):
                light = [lab(stop, eye)[0] for stop in stops]
                if name in ("speed", "cividis"):
                    steps = [b - a for a, b in zip(light, light[1:])]
                    self.assertTrue(all(s > 5 for s in steps) or all(s < -5 for s in steps), (scheme, name, eye, light))
                else:
                    self.assertGreater(difference(stops[0], stops[-1], eye), 20, (scheme, name, eye))
                    middle = len(stops) // 2
                    for half in (stops[middle:], stops[middle::-1]):
                        far = [difference(half[0], stop, eye) for stop in half]
                        self.assertEqual(far, sorted(far), (scheme, name, eye))

    def test_can_read_text_of_every_kind_on_every_ground(self):
        for scheme in ("light", "dark"):
            page = self.four(scheme=scheme)
            for text, grounds in (("--text", ("--page", "--card", "--warn-back", "--bad-back")), ("--quiet", ("--page", "--card", "--grid", "--warn-back", "--bad-back")), ("--accent", ("--page", "--card")),
                                  ("--warn", ("--card", "--warn-back")), ("--bad", ("--card", "--bad-back"))):
                for ground in grounds:
                    self.assertGreaterEqual(contrast(*page.run(f"['{text}', '{ground}'].map(css).map(c => c.length === 4 ? '#' + [...c.slice(1)].map(x => x + x).join('') : c)")), 4.5, (scheme, text, ground))

    def test_meets_no_obstacle(self):
        for file, scheme, screen in itertools.product(("four/report.html", "three.html"), ("light", "dark"), ("desktop", "phone")):
            page = self.open(folder / file, scheme=scheme, screen=screen)
            page.run("document.querySelectorAll('details').forEach(d => { d.open = true; }); document.querySelectorAll('.closed').forEach(e => e.classList.remove('closed'))")
            self.assertEqual(obstacles(page), [], (file, scheme, screen))

    def test_can_press_every_button_on_a_phone(self):
        page = self.four(screen="phone")
        small = page.run("[...document.querySelectorAll('.controls button, .controls select, .controls summary, [role=tab]')].filter(e => e.offsetParent && e.getBoundingClientRect().height < 30).map(e => e.textContent)")
        self.assertEqual(small, [])


if __name__ == "__main__":
    main("numpy", "pandas")

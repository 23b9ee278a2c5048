"""What the pages of runs do under mouse and keys, what can be saved from them, and whether every reader can use them. Needs
chromium and pandas.

usage: check_interactions.py ROULEAU PLUGIN_FOLDER SOURCE_FOLDER
"""
import itertools
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from browser import Browser, BrowserCase, main

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
        return page.run(f"""(() => {{ const a = {ANIMATION}; a.canvas.scrollIntoView({{block: 'center'}}); a.draw(); const box = a.canvas.getBoundingClientRect(), [x, y] = a.centreOf(a.nodes(), {number});
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
        for value, error, words in ((0.34712, 0.0042, "0.347 ± 0.004"), (1.1749, 0.013, "1.175 ± 0.013"), (123.4, 2.1, "123 ± 2"), (-0.5, 0.03, "−0.50 ± 0.03")):
            self.assertEqual(page.run(f"withError({value}, {error})"), words)


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

    def test_keeps_the_cell_that_it_follows_in_the_middle(self):
        page = self.four()
        page.run("document.querySelector('select[aria-label=Cell]').value = '3'; document.querySelector('select[aria-label=Cell]').dispatchEvent(new Event('change'))")
        page.run("[...document.querySelectorAll('label')].find(l => l.textContent === 'Follow').querySelector('input').click()")
        for position in (2, 18):
            page.run(f"timeline.seek({position})")
            self.assertAlmostEqual(*page.run(f"[{ANIMATION}.middle[0], {ANIMATION}.centreOf({ANIMATION}.nodes(), 3)[0]]"), places=4)

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
        self.assertEqual([round(s) for s in page.run(f"{ANIMATION}.wallSpeeds()")], [round(-rate * height / 2), round(rate * height / 2)])
        page.run("timeline.seek(5)")
        self.assertEqual(page.run(f"{ANIMATION}.wallSpeeds()"), [0, 0])
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


def linear(text):
    values = [int(text[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    return [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in values]


def luminance(colour):
    return sum(w * v for w, v in zip((0.2126, 0.7152, 0.0722), linear(colour)))


def contrast(a, b):
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


# Linear RGB as it is seen without one kind of cones (Machado, Oliveira and Fernandes 2009, severity 1).
EYES = {"all": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        "protan": ((0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)),
        "deutan": ((0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881)),
        "tritan": ((1.255528, -0.076749, -0.178779), (-0.078411, 0.930809, 0.147602), (0.004733, 0.691367, 0.303900))}


def lab(colour, eye):
    r, g, b = (min(1, max(0, sum(m * v for m, v in zip(row, linear(colour))))) for row in EYES[eye])
    x, y, z = 0.4124 * r + 0.3576 * g + 0.1805 * b, 0.2126 * r + 0.7152 * g + 0.0722 * b, 0.0193 * r + 0.1192 * g + 0.9505 * b
    f = [t ** (1 / 3) if t > 0.008856 else 7.787 * t + 16 / 116 for t in (x / 0.95047, y, z / 1.08883)]
    return 116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])


class Every_reader(PageOfFour):
    def test_can_tell_any_two_lines_apart(self):
        for scheme in ("light", "dark"):
            page = self.four(scheme=scheme)
            tones = page.run("[...lineTones, '--single'].map(css)")
            for (a, b), eye in itertools.product(itertools.combinations(tones, 2), EYES):
                self.assertGreater(math.dist(lab(a, eye), lab(b, eye)), 20, (scheme, a, b, eye))
            for tone in tones:
                self.assertGreaterEqual(contrast(tone, page.run("css('--card')")), 3, (scheme, tone))

    def test_can_read_all_text(self):
        for scheme in ("light", "dark"):
            page = self.four(scheme=scheme)
            for text, grounds in (("--text", ("--page", "--card", "--warn-back", "--bad-back")), ("--quiet", ("--page", "--card", "--grid", "--warn-back", "--bad-back")), ("--accent", ("--page", "--card")),
                                  ("--warn", ("--card", "--warn-back")), ("--bad", ("--card", "--bad-back"))):
                for ground in grounds:
                    self.assertGreaterEqual(contrast(*page.run(f"['{text}', '{ground}'].map(css).map(c => c.length === 4 ? '#' + [...c.slice(1)].map(x => x + x).join('') : c)")), 4.5, (scheme, text, ground))

    def test_finds_a_name_on_every_control_and_picture(self):
        for file in ("four/report.html", "three.html"):
            page = self.open(folder / file)
            nameless = page.run("""[...document.querySelectorAll('button, select, input, summary, canvas.view, [role=group], [role=tablist], [role=tabpanel], nav')].filter(e =>
                !(e.ariaLabel || e.textContent.trim() || e.title || e.closest('label')?.textContent.trim())).map(e => e.outerHTML.slice(0, 120))""")
            self.assertEqual(nameless, [])
            ids = page.run("[...document.querySelectorAll('[id]')].map(e => e.id)")
            self.assertEqual(len(ids), len(set(ids)))
            self.assertEqual(page.run("[document.documentElement.lang, document.querySelectorAll('h1').length, document.querySelectorAll('main').length]"), ["en", 1, 1])

    def test_can_press_every_button_on_a_phone(self):
        page = self.four(screen="phone")
        small = page.run("[...document.querySelectorAll('.controls button, .controls select, .controls summary, [role=tab]')].filter(e => e.offsetParent && e.getBoundingClientRect().height < 30).map(e => e.textContent)")
        self.assertEqual(small, [])


if __name__ == "__main__":
    main()

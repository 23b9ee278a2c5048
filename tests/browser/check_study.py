"""The pages of studies and of limits, as headless Chromium shows them. Needs chromium and Python's standard library.

usage: check_study.py ROULEAU [--shots FOLDER]    (a screenshot of every page checked)
"""
import base64
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import study_fixture
from browser import SCREENS, Browser, BrowserCase, main
from readers import EYES, contrast, difference, obstacles

PROGRAM = Path(sys.argv[1]).resolve()
SHOTS = Path(sys.argv[3]) if sys.argv[2:3] == ["--shots"] else None
LARGEST_PAGE = 1_000_000


def report(name, result):
    """Page that `rouleau report` makes of a result."""
    directory = folder / name
    directory.mkdir(exist_ok=True)
    kind = "limits" if "rouleau_limits_result" in result else "study"
    (directory / f"{kind}.json").write_text(json.dumps(result, allow_nan=False, sort_keys=True))  # keys in the order of the program's own writer
    made = subprocess.run([PROGRAM, "report", directory], capture_output=True, text=True, timeout=60)
    if made.returncode != 0 or made.stdout != f"{directory / kind}.html\n":
        raise RuntimeError(f"rouleau report: exit code {made.returncode}, {made.stdout}{made.stderr}")
    return directory / f"{kind}.html"


def setUpModule():
    global folder, browser, STUDY, LIMITS, PAGES
    folder = Path(tempfile.mkdtemp(prefix="rouleau-study-"))
    STUDY, LIMITS = study_fixture.study(), study_fixture.limits()
    PAGES = {name: report(name, result) for name, result in
             {"study": STUDY, "large": study_fixture.large_study(), "small": study_fixture.small_study(), "limits": LIMITS}.items()}
    browser = BrowserCase.browser = Browser()


def tearDownModule():
    browser.__exit__()
    shutil.rmtree(folder, ignore_errors=True)


class PageCase(BrowserCase):
    def assert_sound(self, page, width=1280):
        """No exception, no word on the console, nothing fetched, nothing wider than the screen, no number that is none."""
        self.assertEqual(page.faults(), [])
        self.assertLessEqual(page.run("document.scrollingElement.scrollWidth"), width)
        self.assertNotRegex(page.run("document.body.innerText"), r"NaN|undefined|Infinity|\[object")
        self.assertEqual(page.run("[...document.querySelectorAll('svg *')].filter(e => [...e.attributes].some(a => /NaN|undefined|Infinity/.test(a.value))).length"), 0)

    def text(self, page, selector="main"):
        return page.run(f"document.querySelector({selector!r}).textContent")

    def choose(self, page, label, value):
        page.run(f"(s => {{ s.value = {json.dumps(value)}; s.dispatchEvent(new Event('change')); }})(document.querySelector('select[aria-label={json.dumps(label)}]'))")

    def click(self, page, text, within="main"):
        page.run(f"[...document.querySelectorAll('{within} button')].find(b => b.textContent.startsWith({json.dumps(text)})).click()")

    def rows(self, page, heading):
        """Texts of the first table below a heading."""
        return page.run(f"""(() => {{ let e = [...document.querySelectorAll('h2, h3')].find(h => h.textContent === {json.dumps(heading)});
            do e = e.nextElementSibling; while (!e.matches('.scroll') && !e.querySelector('.scroll'));
            return [...e.querySelector('tbody').rows].map(r => [...r.cells].map(c => c.textContent)); }})()""")

    def place(self, page, selector):
        return page.run(f"""(() => {{ const e = document.querySelector({json.dumps(selector)}); e.scrollIntoView({{block: 'center'}});
            const r = e.getBoundingClientRect(); return [r.left + r.width / 2, r.top + r.height / 2]; }})()""")


class Every_page_on_every_screen(PageCase):
    def test_loads_without_a_word_and_fits(self):
        for name, file in PAGES.items():
            self.assertLess(file.stat().st_size, LARGEST_PAGE)
            for screen, size in SCREENS.items():
                for scheme in ("light", "dark"):
                    with self.subTest(page=name, screen=screen, scheme=scheme):
                        page = self.open(file, screen, scheme)
                        self.assertIn(json.loads((file.parent / f"{file.stem}.json").read_text())["title"], self.text(page, "h1"))
                        self.assert_sound(page, size["width"])
                        self.assertEqual(page.run("[...document.querySelectorAll('.stacked td')].filter(td => td.scrollWidth > td.clientWidth + 1).map(td => td.textContent)"), [])
                        if SHOTS:
                            SHOTS.mkdir(parents=True, exist_ok=True)
                            (SHOTS / f"{name}-{screen}-{scheme}.png").write_bytes(base64.b64decode(page.screenshot()))

    def test_shows_markup_of_the_user_as_text(self):
        for name, result in {"study": dict(STUDY, title=study_fixture.MARKUP), "limits": dict(LIMITS, title=study_fixture.MARKUP)}.items():
            result["axes"] = json.loads(json.dumps(result["axes"]).replace("corrected", "<b>corrected</b>"))
            page = self.open(report(f"markup-{name}", json.loads(json.dumps(result).replace('"corrected"', '"<b>corrected</b>"'))))
            self.assertEqual(self.text(page, "h1"), study_fixture.MARKUP)
            self.assertTrue(page.run("document.title").startswith("</script>"))
            self.assertEqual(page.run("document.querySelectorAll('main img, main script, main b b').length"), 0)
            self.assertIn("<b>corrected</b>", self.text(page))
            self.assert_sound(page)

    def test_prints_its_charts_dark_on_white_with_nothing_folded(self):
        for name in ("study", "limits"):
            page = self.open(PAGES[name], scheme="dark")
            page.run("""addEventListener('beforeprint', () => { window.seen = {page: css('--page'), text: css('--text'), open: !document.querySelector('details:not([open])'),
                        charts: [...document.querySelectorAll('.scatter, .map-bar')].every(e => e.querySelector('svg').getAttribute('viewBox').match(/^0 0 (660|330) /))}; }); null""")
            self.assertGreater(len(page.print_pdf()), 10000)
            self.assertEqual(page.run("window.seen"), {"page": "#fff", "text": "#000", "open": True, "charts": True})
            page.wait("!printing && css('--page') === '#14171b'")
            # On a sheet of A4 (182 mm between its margins) no table is cut off.
            page.call("Emulation.setDeviceMetricsOverride", width=688, height=1000, deviceScaleFactor=1, mobile=False)
            page.run("onPaper(true)")
            page.media("light", "print")
            self.assertEqual(page.run("[...document.querySelectorAll('.scroll')].filter(e => e.scrollWidth > e.clientWidth + 1).length"), 0)
            self.assert_sound(page, 688)


class Every_reader(PageCase):
    def test_meets_no_obstacle(self):
        for name in ("study", "limits"):
            for scheme in ("light", "dark"):
                for screen in SCREENS:
                    page = self.open(PAGES[name], scheme=scheme, screen=screen)
                    page.run("document.querySelectorAll('details').forEach(d => { d.open = true; })")
                    self.assertEqual(obstacles(page), [], (name, scheme, screen))

    def test_reaches_a_point_of_the_table_with_the_keyboard(self):
        page = self.open(PAGES["study"])
        page.run("document.querySelector('tr[data-row]').focus()")
        page.key("Enter")
        self.assertEqual(page.run("String(view.point)"), page.run("document.querySelector('tr[data-row]').dataset.row"))

    def test_finds_what_is_planted(self):
        page = self.open(PAGES["limits"])
        page.run("""document.querySelector('main').insertAdjacentHTML('beforeend',
            '<p style="color: #999; background: #fff">pale</p><button></button><span style="cursor: pointer">x</span><h4>deep</h4><i id="page"></i>')""")
        found = "\n".join(obstacles(page))
        for words in ("contrast 2.8", "no name: <button", "out of the keyboard's reach: <span", "level 4 follows", "twice: id page"):
            self.assertIn(words, found)


class What_the_pages_are_tested_with(unittest.TestCase):
    def test_is_what_the_program_s_schemas_allow(self):
        try:
            import jsonschema
        except ImportError:
            self.skipTest("there is no python3-jsonschema (scripts/install-dependencies --full installs it)")
        source = Path(__file__).resolve().parent.parent.parent
        results = {"host/study/study-result.schema.json": (STUDY, study_fixture.large_study(), study_fixture.small_study()), "host/stability/limits-result.schema.json": (LIMITS,)}
        for name, fixtures in results.items():
            if (source / name).exists():
                schema = json.loads((source / name).read_text())
                for fixture in fixtures:
                    jsonschema.validate(fixture, schema)


class The_page_of_a_study(PageCase):
    CHARTS = "[...document.querySelectorAll('.scatter')].map(c => c.innerHTML)"
    SHOWN = "[...document.querySelectorAll('.scatter')].map(c => c.querySelectorAll('[data-point]').length)"

    def test_begins_with_its_sentences_and_then_its_warnings(self):
        page = self.open(PAGES["study"])
        boxes = page.run("[...document.querySelectorAll('.status')].map(e => [...e.querySelectorAll('li')].map(l => l.textContent))")
        self.assertIn(STUDY["sentences"][0]["text"].replace("+-", "±"), boxes[0][0])
        self.assertIn("below 1 × 10⁻⁷. The nearest is resolution 40, tau 1, scheme corrected", boxes[0][1])
        self.assertEqual(len(boxes[0]), 2)  # where methods disagree is a warning
        warnings = "\n".join(boxes[1])
        for words in ("The methods disagree about deformation", "6 of 40 points failed", "1 point was left out", "not deterministic: resolution 5, tau 0.6, corrected: cells.csv"):
            self.assertIn(words, warnings)

    def test_draws_every_point_of_both_charts_and_marks_those_that_failed(self):
        page = self.open(PAGES["study"])
        self.assertEqual(page.run(self.SHOWN), [40, 40])
        self.assertEqual(page.run("document.querySelectorAll('.scatter .cross').length"), 2 * 6)
        self.assertEqual(page.run("document.querySelectorAll('.scatter .unknown').length"), 2 * 2)
        self.assertEqual(page.run("[...document.querySelectorAll('.scatter .band')].length"), 2)
        self.assertEqual(page.run("[...document.querySelectorAll('.scatter .strong')].map(t => t.textContent)"), ["cheapest below 5 %", "default"] * 2)

    def test_has_guides_that_fall_with_the_lines_of_its_methods(self):
        page = self.open(PAGES["study"])
        # Errors fall along both lines; the worst method is there at the fine end alone.
        line = "(x, y) => ({x, y})"
        lines = f"(p => [{{points: [p(10, 1), p(20, .3)]}}, {{points: [p(20, 90), null, p(10, 200)]}}, {{points: [p(20, 800)]}}, {{points: [p(20, 900)]}}, {{points: [p(20, 950)]}}])({line})"
        for scale, falls in ((1, True), (-1, False)):
            guides = page.run(f"(lines => slopesOf({{lines, drawn: lines.flatMap(l => l.points.filter(Boolean))}}))({lines}.map(l => ({{points: l.points.map(p => p && {{x: {scale} > 0 ? p.x : 200 / p.x, y: p.y}})}})))")
            self.assertEqual([guide["text"] for guide in guides], ["order 1", "order 2"])
            for guide in guides:
                self.assertLess(guide["to"]["y"], guide["from"]["y"])
                self.assertEqual(guide["from"]["x"] < guide["to"]["x"], falls)

    def test_draws_a_point_at_its_time_and_error(self):
        page = self.open(PAGES["study"])
        for point in (STUDY["points"][10], STUDY["points"][-1]):
            x, y = page.run(f"(s => [s.x, s.y])(ScatterChart.all[0].spots.find(s => s.id === {point['id']}))")
            self.assertAlmostEqual(x, page.run(f"ScatterChart.all[0].x.at({point['wall_s']['median']})"), places=6)
            self.assertAlmostEqual(y, page.run(f"ScatterChart.all[0].y.at({100 * point['results']['deformation']['error']})"), places=6)
        # A logarithmic axis: equal ratios are equal distances.
        a, b, c = page.run("[1, 10, 100].map(v => ScatterChart.all[0].x.at(v))")
        self.assertAlmostEqual(b - a, c - b, places=6)

    def test_has_the_front_of_the_study_and_computes_that_of_the_other_time_alike(self):
        page = self.open(PAGES["study"])
        self.assertEqual(page.run("view.front"), STUDY["fronts"]["deformation"])
        told = page.run("view.front")
        page.run("view.study.fronts = {}")
        self.assertEqual(page.run("view.front"), told)

    def test_tells_of_the_point_under_the_mouse(self):
        page = self.open(PAGES["study"])
        completed = next(p for p in STUDY["points"] if p["labels"] == {"resolution": "40", "tau": "0.8", "scheme": "corrected"})
        failed = next(p for p in STUDY["points"] if p["status"] == "diverged")
        for point, words in ((completed, ["resolution 40, tau 0.8, corrected", "wall time", "3 runs", "processor time", "memory", "steps18", "error0."]),
                             (failed, ["Diverged, node_step, at step 812", "Node 17", "Lower density_factor"])):
            page.mouse("mouseMoved", *self.place(page, f".scatter [data-point='{point['id']}']"))
            page.wait("!document.querySelector('.tip').hidden")
            for text in words:
                self.assertIn(text.replace("_", " ") if text.startswith("Div") else text, self.text(page, ".tip"))
            self.assertEqual(page.run("ScatterChart.all.map(c => c.ring.getAttribute('visibility'))"), ["visible", "visible"])
        page.mouse("mouseMoved", 2, 2)
        page.wait("document.querySelector('.tip').hidden")
        self.assert_sound(page)

    def test_can_be_read_with_the_keyboard(self):
        page = self.open(PAGES["study"])
        page.run("document.querySelector('.scatter').focus()")
        words = []
        for _ in range(3):
            page.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowRight")
            words.append(self.text(page, ".tip"))
        self.assertEqual(len(set(words)), 3)
        at = page.run("ScatterChart.all[0].at")
        page.call("Input.dispatchKeyEvent", type="keyDown", key="Enter")
        self.assertEqual(page.run("view.point"), at)

    def test_hides_methods_by_name_and_by_label(self):
        page = self.open(PAGES["study"])
        self.click(page, "tau 0.8, plain", ".legend")
        self.assertEqual(page.run(self.SHOWN), [35, 35])
        self.click(page, "corrected", ".choices")
        self.assertEqual(page.run(self.SHOWN), [15, 15])
        self.assertEqual(page.run("[...document.querySelectorAll('.legend button')].filter(b => b.getAttribute('aria-pressed') === 'true').length"), 3)
        self.click(page, "corrected", ".choices")
        self.click(page, "tau 0.8, plain", ".legend")
        self.assertEqual(page.run(self.SHOWN), [40, 40])
        self.assert_sound(page)

    def test_changes_with_the_quantity_and_the_time(self):
        page = self.open(PAGES["study"])
        first = page.run(self.CHARTS)
        self.choose(page, "Time", "cpu_s")
        self.assertNotEqual(page.run(self.CHARTS)[0], first[0])
        self.assertEqual(page.run(self.CHARTS)[1], first[1])
        self.assertIn("processor time", self.text(page, ".chart h3"))
        self.choose(page, "Time", "wall_s")
        self.choose(page, "Quantity", "1")
        self.assertIn("area drift", self.text(page, ".chart h3"))
        self.assertEqual(page.run("document.querySelectorAll('.scatter .band').length"), 0)
        self.assertIn("No two points differ", self.text(page))
        self.assertIn("nearest to 1 × 10⁻⁷", page.run("[...document.querySelectorAll('.scatter .strong')].map(t => t.textContent).join()"))
        drift = STUDY["points"][0]["results"]["area drift"]["error"]
        self.assertAlmostEqual(float(self.rows(page, "Points")[0][6]), drift, delta=1e-3 * drift)
        self.choose(page, "Quantity", "0")
        self.assertEqual(page.run(self.CHARTS), first)
        self.assert_sound(page)

    def test_sorts_its_table_of_points_with_undefined_ones_last(self):
        page = self.open(PAGES["study"])
        self.assertEqual(len(self.rows(page, "Points")), 40)
        for times, order in ((1, sorted), (2, lambda values: sorted(values, reverse=True))):
            self.click(page, "Error", ".points th")
            errors = [row[6] for row in self.rows(page, "Points")]
            numbers = [float(e) for e in errors if e != "–"]
            self.assertEqual(errors[len(numbers):], ["–"] * 8)
            self.assertEqual(numbers, order(numbers))
            self.assertEqual(page.run("document.querySelector('.points th[aria-sort]').getAttribute('aria-sort')"), {1: "ascending", 2: "descending"}[times])

    def test_says_which_setting_gains_most(self):
        page = self.open(PAGES["study"])
        self.assertEqual(self.rows(page, "Which setting helps most")[:2], [["tau", "1", "2", "resolution 20, plain", "÷ 1.4", "× 0.35", "free"],
                                                                       ["scheme", "plain", "corrected", "resolution 20, tau 1", "÷ 3.2", "× 1.15", "8.4"]])

    def test_shows_a_point_s_time_by_pass_when_it_is_chosen(self):
        page = self.open(PAGES["study"])
        point = STUDY["points"][-1]
        page.run(f"document.querySelector('tr[data-row=\"{point['id']}\"]').click()")
        slowest = max(p["wall_s"] for p in point["passes"])
        self.assertEqual(self.rows(page, "Time by pass")[0][:3], ["collide and stream", self.seconds(slowest), "52.0 %"])
        self.assertEqual(page.run("document.querySelectorAll('.ring.chosen').length"), 2)
        self.click(page, "show", ".sentences")
        self.assertEqual(page.run("view.point"), STUDY["sentences"][0]["point"])

    def seconds(self, value):
        return f"{value:.3g} s"

    def test_names_what_it_knows_nothing_of(self):
        page = self.open(PAGES["small"])
        self.assertIn("Richardson wants three points", self.text(page, ".status.warn"))
        self.assertEqual(page.run("document.querySelectorAll('.scatter svg').length"), 0)
        self.assertIn("No errors to draw", self.text(page))
        self.assertEqual([row[1] for row in self.rows(page, "Points")], ["plain", "corrected"])

    def test_draws_an_axis_of_names_and_an_error_of_zero(self):
        result = study_fixture.small_study()
        for point, error in zip(result["points"], (0.02, 0)):
            point["results"]["deformation"].update(error=error, why_not=None)
        page = self.open(report("named", result))
        self.assertEqual(page.run(self.SHOWN), [2, 2])
        self.assertEqual(page.run("document.querySelectorAll('.mark.open').length"), 2)
        self.assertIn("exactly 0", self.text(page, ".chart"))
        self.assertIn("corrected", page.run("[...document.querySelectorAll('.scatter')][1].textContent"))
        self.assert_sound(page)

    def test_with_long_names_is_no_wider_than_a_phone(self):
        text = json.dumps(STUDY)
        for word in ("corrected", "deformation", "scheme"):
            text = text.replace(f'"{word}"', f'"{word} of the membranes in a slow shear flow between walls"')
        self.assert_sound(self.open(report("long", json.loads(text)), "phone"), 390)

    def test_of_a_study_without_points_is_still_a_page(self):
        page = self.open(report("empty", dict(STUDY, points=[], fronts={}, knobs={}, sentences=[])))
        self.assertIn("No point has been run.", self.text(page))
        self.assert_sound(page)

    def test_has_room_for_three_hundred_points_of_sixty_methods(self):
        page = self.open(PAGES["large"])
        self.assertEqual(page.run(self.SHOWN), [300, 300])
        self.assertLess(page.run("document.querySelectorAll('.scatter svg *').length"), 300 * 2 * 4)
        for text in ("twice corrected", "plain"):
            self.click(page, text, ".choices")
        self.assertEqual(page.run(self.SHOWN), [100, 100])
        self.assert_sound(page)


class The_page_of_limits(PageCase):
    def bar(self, page, name):
        """Stretches of the bar of a combination as [class, from, to] in values of the parameter."""
        return page.run(f"""(() => {{ const row = map.rows.find(r => r.name === {json.dumps(name)}); return stretches(row, map.low, map.high).map(s => [s.what, s.from, s.to]); }})()""")

    def test_says_first_what_the_map_comes_to(self):
        page = self.open(PAGES["limits"])
        words = self.text(page, ".status")
        self.assertIn("9 combinations: 1 is stable throughout, 1 fails everywhere, 7 have an edge.", words)
        self.assertIn("First to fail: ", words)
        legend = self.text(page, ".legend.map")
        for reason in ("node step", "area loss", "timed out"):
            self.assertIn(f"fails: {reason}", legend)

    def test_has_a_blue_for_stable_that_no_eye_takes_for_a_failure(self):
        for scheme in ("light", "dark"):
            stable, *failing, card = self.open(PAGES["limits"], scheme=scheme).run("['--stable', ...Object.values(failureReasons).map(([tone]) => tone), '--card'].map(css)")
            self.assertEqual(len(failing), 7)
            for tone in failing:
                self.assertGreaterEqual(contrast(tone, card.ljust(7, card[-1])), 3, (scheme, tone))
                for eye in EYES:
                    self.assertGreater(difference(stable, tone, eye), 20, (scheme, tone, eye))

    def test_draws_stable_and_failing_stretches_between_the_edges(self):
        page = self.open(PAGES["limits"])
        self.assertEqual(page.run("map.rows.length"), 9)
        edge = {(e["labels"]["scheme"], e["labels"]["kernel"], e["direction"]): e for e in LIMITS["edges"]}
        above, below = edge["plain", "linear2", "above"], edge["plain", "linear2", "below"]
        self.assertEqual(self.bar(page, "plain, linear2"), [
            ["failing", 6e-6, below["unstable_from"]], ["open", below["unstable_from"], below["stable_up_to"]], ["stable", below["stable_up_to"], above["stable_up_to"]],
            ["open", above["stable_up_to"], above["unstable_from"]], ["failing", above["unstable_from"], 6e-2]])
        self.assertEqual(self.bar(page, "semi-implicit, cosine4"), [["stable", 6e-6, 6e-2]])
        self.assertEqual(self.bar(page, "corrected, cosine4"), [["failing", 6e-6, 6e-2]])
        # Each row says in words what its colours say.
        self.assertIn("node step", page.run("map.rows[0].line.textContent"))
        self.assertEqual(page.run("document.querySelectorAll('.map-bar .trial').length"), sum(len(e["trials"]) for e in LIMITS["edges"]))

    def test_tells_of_a_trial_under_the_mouse(self):
        page = self.open(PAGES["limits"])
        x, y = self.place(page, ".map-row:nth-child(2) .map-bar")
        width = page.run("document.querySelector('.map-bar').clientWidth")
        first = page.run(f"map.axis.at({LIMITS['edges'][0]['unstable_from']})")
        page.mouse("mouseMoved", x - width / 2 + first + 1, y)
        page.wait("!document.querySelector('.tip').hidden")
        for words in ("N/m, plain, peskin4", "Diverged", "node_step", "step 400", "a node moved too far", "Lower the time step."):
            self.assertIn(words, self.text(page, ".tip"))
        page.mouse("mouseMoved", x - width / 2 + 4, y)
        page.wait("document.querySelector('.tip').textContent.includes('Stable')")
        silent = page.run(f"map.axis.at({LIMITS['edges'][-1]['out_of_order'][0]})")
        x, y = self.place(page, ".map-row:nth-child(10) .map-bar")
        page.mouse("mouseMoved", x - width / 2 + silent, y)
        page.wait("document.querySelector('.tip').textContent.includes('Silent failure')")
        self.assertIn("Contradicts the edge", self.text(page, ".tip"))
        self.assert_sound(page)

    def test_hides_and_orders_combinations(self):
        page = self.open(PAGES["limits"])
        shown = "[...document.querySelectorAll('.map-row:not([hidden]) > b')].map(e => e.textContent).filter(t => t)"
        self.click(page, "peskin4", ".choices")
        self.assertEqual(len(page.run(shown)), 6)
        self.click(page, "peskin4", ".choices")
        self.choose(page, "Order", "edge")
        order = page.run(shown)
        self.assertEqual((order[0], order[-1]), ("semi-implicit, cosine4", "corrected, cosine4"))
        self.assert_sound(page)

    def test_has_the_same_in_its_tables(self):
        page = self.open(PAGES["limits"])
        self.assertEqual(len(self.rows(page, "Edges")), len(LIMITS["edges"]))
        self.assertEqual(self.rows(page, "Stable range, as a grid")[2][2][:7], "nowhere")
        self.assertEqual(self.rows(page, "Edges")[-1][-1], page.run(f"format({LIMITS['edges'][-1]['out_of_order'][0]}, 3)"))
        self.assertIn("a factor of 1.1", self.text(page))

    def test_of_a_search_that_was_stopped_at_once_knows_nothing_yet(self):
        result = json.loads(json.dumps(LIMITS))
        result["edges"][0].update(stable_up_to=None, unstable_from=None, failure=None, trials=[])
        page = self.open(report("stopped", dict(result, complete=False)))
        self.assertEqual(self.bar(page, "plain, peskin4"), [["open", 6e-6, 6e-2]])
        self.assertIn("of 1 nothing is known yet", self.text(page, ".status"))
        self.assertIn("is not finished", self.text(page, ".status.warn"))
        self.assert_sound(page)

    def test_has_an_even_axis_where_the_file_asks_for_one(self):
        result = json.loads(json.dumps(LIMITS))
        result["parameter"].update({"scale": "linear", "from": -1, "to": 3, "unit": ""})
        result["edges"] = [{"labels": {}, "stable_up_to": 1, "unstable_from": 1.2, "direction": "above", "failure": None,
                            "trials": [{"value": v, "end": "completed" if v < 1.1 else "crashed", "reason": None, "step": None} for v in (-1, 1, 1.2, 3)]}]
        result.update(axes=[])
        page = self.open(report("linear", result))
        a, b, c = page.run("[-1, 1, 3].map(v => map.axis.at(v))")
        self.assertAlmostEqual(b - a, c - b, places=6)
        self.assertIn("stable up to 1", self.text(page, ".map-card"))
        self.assert_sound(page)


if __name__ == "__main__":
    main()

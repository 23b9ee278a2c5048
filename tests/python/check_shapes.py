"""rouleau.outline, mask, vessel and polygons: what they make of arrays and drawings, against areas and pixels that are known."""

import importlib.util
import math

from package import Case, main, need

need("numpy", "matplotlib")

import numpy  # noqa: E402
import rouleau  # noqa: E402
from matplotlib import image  # noqa: E402

SQUARE = numpy.array([[0, 0], [4, 0], [4, 4], [0, 4]]) * 1e-6


def area(polygon):
    """Positive where it is counter-clockwise."""
    x, y = polygon.T
    return float((x * numpy.roll(y, -1) - numpy.roll(x, -1) * y).sum() / 2)


class An_outline(Case):
    def test_has_each_corner_once(self):
        shape = rouleau.outline(numpy.vstack([SQUARE, SQUARE[:1]]), lower=0, upper="2 um")
        self.assertEqual(shape, {"outline": {"points": SQUARE.tolist(), "lower": 0, "upper": "2 um"}})
        self.assertEqual(list(rouleau.outline(SQUARE)["outline"]), ["points"])

    def test_is_refused_where_it_encloses_nothing(self):
        self.assert_refused("2 different corners", rouleau.outline, [[0, 0], [1, 0], [0, 0]])
        self.assert_refused("shape [2, 3]", rouleau.outline, [[0, 0, 0], [1, 0, 0]])
        self.assert_refused("no numbers", rouleau.outline, [[0, 0], [1, math.nan], [0, 1]])
        for points in ("abc", [[0, 0], [1], [2, 2]], [["0 um", "0 um"], ["4 um", "0 um"], ["4 um", "4 um"]], SQUARE * 1j, [[0, 10**400]] * 3):
            self.assert_refused("no polygon", rouleau.outline, points)


class A_mask(Case):
    def test_is_a_picture_with_the_lowest_row_below(self):
        values = numpy.random.default_rng(1).random((5, 7))
        shape = rouleau.mask(values, self.path / "mask.png", "0.5 um", at=["1 um", "2 um"])
        self.assertEqual(shape["image"], {"file": str(self.path / "mask.png"), "pixel": "0.5 um", "fluid": "light", "at": ["1 um", "2 um"]})
        read = image.imread(self.path / "mask.png")  # by another reader of PNG, from 0 to 1
        numpy.testing.assert_allclose(read[::-1], values, atol=0.5 / 255 + 1e-7)

    def test_of_layers_is_a_stack_of_pictures(self):
        values = numpy.zeros((3, 2, 4), dtype=bool)
        values[1, 0, 3] = True
        files = rouleau.mask(values, self.path / "layer.png", 1e-6, spacing=2e-6)["image"]["file"]
        self.assertEqual(files, [str(self.path / f"layer-{k:04}.png") for k in range(3)])
        for layer, file in zip(values, files):
            numpy.testing.assert_array_equal(image.imread(file)[::-1], layer)

    def test_is_refused_where_it_is_none(self):
        self.assert_refused("from 0 to 1", rouleau.mask, [[0, 255]], self.path / "a.png", 1e-6)
        self.assert_refused("shape [2]", rouleau.mask, [0, 1], self.path / "a.png", 1e-6)
        for values in ([["a"]], [[0, 1], [1]]):
            self.assert_refused("no mask", rouleau.mask, values, self.path / "a.png", 1e-6)
        self.assert_refused("spacing of layers", rouleau.mask, numpy.zeros((2, 2, 2)), self.path / "a.png", 1e-6)
        self.assertEqual(list(self.path.iterdir()), [])


class A_vessel(Case):
    def test_has_obstacles_where_polygons_lie_in_others(self):
        hole, beside = SQUARE / 4 + 1e-6, SQUARE + [1e-5, 0]
        keys = rouleau.vessel([hole, SQUARE, beside])
        self.assertEqual(keys, {"walls": {"within": {"union": [rouleau.outline(SQUARE), rouleau.outline(beside)]}}, "obstacles": [rouleau.outline(hole)]})
        self.assertEqual(rouleau.vessel([SQUARE]), {"walls": {"within": rouleau.outline(SQUARE)}})
        self.assert_refused("lies in an obstacle", rouleau.vessel, [SQUARE, hole, SQUARE / 16 + 1.2e-6])
        self.assert_refused("no polygons", rouleau.vessel, [])
        self.assert_refused("no polygons", rouleau.vessel, None)
        self.assert_refused("0 different corners", rouleau.vessel, [numpy.zeros((0, 2))])
        self.assertEqual(rouleau.vessel([SQUARE, SQUARE.copy()]), {"walls": {"within": {"union": [rouleau.outline(SQUARE)] * 2}}})


class A_drawing(Case):
    def svg(self, body, view="0 0 100 50"):
        file = self.path / "drawing.svg"
        file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view}">{body}</svg>')
        return [polygon * 1e6 for polygon in rouleau.polygons(file, deviation=0.01)]

    def test_as_svg_stands_upright_with_its_lower_left_corner_at_the_origin(self):
        found, = self.svg('<rect x="20" y="40" width="10" height="5"/>', view="10 0 100 50")
        numpy.testing.assert_allclose([found.min(axis=0), found.max(axis=0)], [[10, 5], [20, 10]])

    def test_as_svg_has_the_areas_of_its_closed_lines(self):
        shapes = {'<path d="M0 0h20v10H0z"/>': 200, '<polygon points="0,0 10,0 0,10"/>': 50, '<circle cx="9" cy="9" r="5"/>': 25 * math.pi,
                  '<ellipse cx="9" cy="9" rx="5" ry="2"/>': 10 * math.pi, '<path d="M 5,0 A 5 5 0 0 1 5,10 A 5,5 0 1 1 5,0"/>': 25 * math.pi,
                  '<path d="M5,0A5 5 0 015,10A5 5 0 115,0"/>': 25 * math.pi, '<path d="M0,0a5,5 0 00.5e1-5a5-5 0 00-5 5"/>': 25 * math.pi / 2 - 25,
                  '<rect x="1" y="2" width="10" height="6" rx="2"/>': 60 - 4 * (4 - math.pi), '<rect width="10" height="6" rx="9" ry="3"/>': 15 * math.pi,
                  '<path d="M0 0 A 8 4 30 0 0 6 6 A 8 4 30 1 0 0 0 z"/>': 32 * math.pi,  # two arcs of one ellipse
                  # Under a parabola a third of the triangle of its control points is left out.
                  '<path d="M0 0 Q 5 10 10 0 z"/>': 100 / 3, '<path d="M0 0 Q 5 10 10 0 T 20 0 L 20 -5 L 0 -5z"/>': 100,
                  # A cubic with the parabola's controls is the parabola.
                  '<path d="m0 0 c 3.3333333 6.6666667 6.6666667 6.6666667 10 0 z"/>': 100 / 3,
                  '<g transform="translate(5,5) scale(2)"><g transform="rotate(30)"><rect width="3" height="4"/></g></g>': 48,
                  '<g transform="matrix(1 0 1 2 0 0)"><circle r="1"/></g>': 2 * math.pi}
        for body, expected in shapes.items():
            with self.subTest(body):
                found, = self.svg(body)
                self.assertAlmostEqual(abs(area(found)), expected, delta=0.01 * numpy.linalg.norm(numpy.diff(found, axis=0), axis=1).sum() + 1e-6)

    def test_as_svg_has_every_part_of_a_path_and_no_open_line(self):
        self.assertEqual([len(p) for p in self.svg('<path d="M0 0h9v9H0z m1 1h2v2z M50 0 L60 0 L60 9"/><path d="M0 0 1 0"/>')], [4, 3])
        self.assert_refused("no closed line", self.svg, '<path d="M0 0 L9 9 L 9 0"/>')
        self.assert_refused('"skewX" is not read', self.svg, '<g transform="skewX(30)"><rect width="1" height="1"/></g>')
        self.assert_refused("no SVG that can be read", self.svg, '<path d="M0"/>')
        self.assert_refused("no SVG that can be read", self.svg, "<rect")

    def test_as_svg_has_lengths_with_units_in_px(self):
        found, = self.svg('<rect x="1cm" y="-1in" width="10mm" height="36pt"/>')
        numpy.testing.assert_allclose([found.min(axis=0), found.max(axis=0)], [[96 / 2.54, 98], [192 / 2.54, 146]])
        file = self.path / "page.svg"
        file.write_text('<svg width="1in" height="1in"><rect width="96px" height="6pc"/></svg>')
        numpy.testing.assert_allclose(rouleau.polygons(file, 1e-3)[0].min(axis=0), [0, 0], atol=1e-12)

    def test_as_svg_leaves_out_what_is_not_drawn(self):
        unseen = '<g style="fill:red; display : none"><rect width="9" height="9"/></g><rect display="none" width="9" height="9"/><circle/>' \
            '<rect width="0" height="9"/><rect transform="scale(0)" width="9" height="9"/><defs><use href="#a"/></defs>'
        found, = self.svg(unseen + '<polyline points="0,0 9,0 9,9 0,0"/><polyline points="0,0 9,0 9,9"/>')
        numpy.testing.assert_allclose(found, [[0, 50], [9, 50], [9, 41]])
        found, = self.svg('<path d="M0 0h9h0v9L0 0z M0 0h9z"/>')  # points that come twice, and a line that encloses nothing
        numpy.testing.assert_allclose(found, [[0, 50], [9, 50], [9, 41]])

    def test_as_svg_is_refused_with_the_element_that_is_not_read(self):
        for body, words in (('<rect width="10%" height="5"/>', '<rect>: width is "10%"'), ('<rect width="nan" height="5"/>', '<rect>: width is "nan"'),
                            ('<circle r="-1"/>', '<circle>: r is "-1"'), ('<rect width="2em" height="5"/>', 'width is "2em"'),
                            ('<use id="b" href="#a" x="30"/>', '<use id="b">: it stands for another'), ('<svg x="3"/>', "<svg>: a drawing in a drawing"),
                            ('<g id="c" style="transform:translate(20px,0)"/>', '<g id="c">: CSS sets transform'), ("<g visibility='hidden'/>", "is hidden"),
                            ('<defs><style>.a{fill:red;display:none}</style></defs>', "CSS sets display"),
                            ('<g transform="rotate(30,5)"/>', '"rotate" has 2 numbers'), ('<path d="M0 0 L nan 5 4 4z"/>', '<path>: "nn" is not understood'),
                            ('<path d="M0 0A5 5 0 2 1 5 5z"/>', '"A" is not understood'), ('<polygon points="0,0 9,0 9"/>', '"L" is not understood')):
            with self.subTest(body):
                self.assert_refused(words, self.svg, '<rect style="stroke-width:2" width="9" height="5"/>' + body)

    def test_as_dxf_has_its_closed_lines_and_those_that_meet(self):
        if not importlib.util.find_spec("ezdxf"):
            self.skipTest("ezdxf is missing")
        import ezdxf
        drawing = ezdxf.new()
        model = drawing.modelspace()
        model.add_circle((0, 0), 5)
        model.add_lwpolyline([(0, 0), (10, 0), (10, 10)], close=True)
        for a, b in (((20, 0), (30, 0)), ((30, 10), (30, 0)), ((30, 10), (20, 0)), ((50, 0), (60, 0))):
            model.add_line(a, b)
        model.add_text("no outline")
        drawing.saveas(self.path / "drawing.dxf")
        found = rouleau.polygons(self.path / "drawing.dxf", unit_m=1e-3, deviation=0.01)
        for polygon, expected in zip(found, (25 * math.pi, 50, 50), strict=True):
            self.assertAlmostEqual(abs(area(polygon)) * 1e6, expected, delta=0.32)

    def test_is_refused_where_it_is_none(self):
        for name in ("a.dxf", "a.png"):
            (self.path / name).write_text("no drawing")
        self.assert_refused('".png"', rouleau.polygons, self.path / "a.png")
        self.assert_refused("no plain file", rouleau.polygons, self.path / "none.svg")
        for words in ({"unit_m": "1 um"}, {"unit_m": math.nan}, {"deviation": 0}):
            self.assert_refused(f"{list(words)[0]} is", rouleau.polygons, self.path / "a.svg", **words)
        refused = "no DXF file" if importlib.util.find_spec("ezdxf") else "which is not installed"
        self.assert_refused(refused, rouleau.polygons, self.path / "a.dxf")


if __name__ == "__main__":
    main()

"""The pages of the documentation in reading order: what the site shows and the tests of tests/docs go through."""
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CHAPTERS = {
    "Begin": ["README.md", "docs/pages.md", "docs/install.md", "docs/first-run.md", "docs/first-run-3d.md",
              "docs/tutorial.md", "docs/worked-scenes.md", "docs/gallery.md", "docs/comparison.md", "docs/faq.md", "docs/glossary.md"],
    "Use": ["docs/commands.md", "docs/scene.md", "docs/three-dimensions.md", "docs/walls.md", "docs/models.md", "docs/output.md",
            "docs/output-tables.md", "docs/output-frames.md", "docs/output-summary.md", "docs/output-report.md", "docs/python.md",
            "docs/error-bars.md", "docs/auto.md", "docs/simulation.md", "docs/library.md", "docs/resume.md", "docs/ranks.md",
            "docs/rheology.md", "docs/study-quantities.md"],
    "Reference": ["docs/reference/scene.md", "docs/reference/models.md", "docs/reference/python.md"],
    "Trust the numbers": ["docs/physics.md", "docs/accuracy.md", "docs/experiments.md", "docs/capillaries.md", "docs/blood.md", "docs/study.md", "docs/stability.md",
                          "docs/paper.md", "docs/performance.md"],
    "Extend": ["sdk/README.md", "docs/conformance.md", "docs/conformance-checks.md", "docs/compatibility.md", "docs/trust.md",
               "docs/methods.md", "docs/architecture.md", "docs/testing.md", "CONTRIBUTING.md"],
    "Logs": sorted(str(page.relative_to(ROOT)) for page in (ROOT / "docs/results").glob("*.md")),
}
PAGES = [page for pages in CHAPTERS.values() for page in pages]

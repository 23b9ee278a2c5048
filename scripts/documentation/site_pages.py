"""Renders all pages to HTML with one navigation; links between pages and to files of the source go on working from the disk."""

import html
import os
import pathlib
import re
import shutil
import sys

from pages import CHAPTERS, PAGES

STYLE = pathlib.Path(__file__).with_name("site.css")
LINK = re.compile(r'(href|src)="([^"#:]*)(#[^"]*)?"')
PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title} - Rouleau</title>
<link rel="stylesheet" href="site.css">
</head>
<body>
<a class="menu" href="#pages">All pages</a>
<main>
{body}
<footer>{previous}{next}</footer>
</main>
<nav id="pages">
{navigation}
</nav>
</body>
</html>
"""


def name_of(page):
    if page == "README.md":
        return "index.html"
    return page.removeprefix("docs/").removesuffix(".md").replace("/", "-").replace("README", "index").lower() + ".html"


def slug(text, separator="-"):
    """The anchor GitHub gives a heading: other words would break links that work there."""
    return re.sub(r"[^\w\- ]", "", text.lower()).strip().replace(" ", separator)


def rendered(text):
    import markdown

    converter = markdown.Markdown(
        extensions=["tables", "fenced_code", "sane_lists", "toc"],
        extension_configs={"toc": {"slugify": slug, "toc_depth": "2-3"}})
    body = converter.convert(text)
    # A table wider than a phone scrolls by itself and leaves the page where it is.
    body = body.replace("<table>", '<div class="table"><table>').replace("</table>", "</table></div>")
    return body, converter.toc_tokens


def title_of(root, page):
    return (root / page).read_text().split("\n", 1)[0].lstrip("# ")


def plain(text):
    return html.escape(text.replace("`", ""))


def navigation(titles, current, sections):
    lines = []
    for chapter, pages in CHAPTERS.items():
        lines.append(f"<p>{chapter}</p><ul>")
        for page in pages:
            here = ' aria-current="page"' if page == current else ""
            lines.append(f'<li><a href="{name_of(page)}"{here}>{plain(titles[page])}</a>')
            if page == current and sections:
                entries = "".join(f'<li><a href="#{token["id"]}">{token["name"]}</a></li>' for token in sections)
                lines.append(f"<ul>{entries}</ul>")
            lines.append("</li>")
        lines.append("</ul>")
    return "\n".join(lines)


def relinked(body, root, page, out):
    """Links to pages lead to their HTML; files of the source are copied beside it, folders only named."""
    def one(match):
        attribute, target, anchor = match[1], match[2], match[3] or ""
        if not target:
            return match[0]
        path = os.path.normpath(os.path.join(os.path.dirname(page), target))
        if path in PAGES:
            return f'{attribute}="{name_of(path)}{anchor}"'
        if (root / path).is_file():
            copy = out / "files" / path
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(root / path, copy)
            return f'{attribute}="files/{path}{anchor}"'
        raise SystemExit(f"{page}: no file {target}")
    return LINK.sub(one, body)


def write(root, out):
    try:
        import markdown  # noqa: F401
    except ImportError:
        print("scripts/docs: the site needs the package python3-markdown: apt-get install python3-markdown", file=sys.stderr)
        return 4
    out.mkdir(parents=True, exist_ok=True)
    titles = {page: title_of(root, page) for page in PAGES}
    for place, page in enumerate(PAGES):
        body, tokens = rendered((root / page).read_text())
        step = {}
        for word, other in (("previous", place - 1), ("next", place + 1)):
            there = PAGES[other] if 0 <= other < len(PAGES) else None
            step[word] = f'<a class="{word}" href="{name_of(there)}">{plain(titles[there])}</a>' if there else ""
        text = PAGE.format(title=plain(titles[page]), navigation=navigation(titles, page, tokens),
                           body=relinked(body, root, page, out), **step)
        (out / name_of(page)).write_text(text)
    shutil.copyfile(STYLE, out / "site.css")
    print(out / "index.html")
    return 0

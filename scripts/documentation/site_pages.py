"""Renders all pages to HTML with one navigation, search, typeset formulas and, where doxygen is installed, the pages of the
interfaces; all of it works from the disk."""

import html
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

from pages import CHAPTERS, PAGES

HERE = pathlib.Path(__file__).parent
# Debian's packages libjs-katex and libjs-lunr.
LIBRARIES = pathlib.Path("/usr/share/javascript")
INTERFACES = ["sdk/include/rouleau", "host/core"]
LINK = re.compile(r'(href|src)="([^"#:]*)(#[^"]*)?"')
PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title} - Rouleau</title>
<link rel="stylesheet" href="katex/katex.min.css">
<link rel="stylesheet" href="site.css">
</head>
<body>
<a class="menu" href="#pages">All pages</a>
<main>
{body}
<footer>{previous}{next}</footer>
</main>
<nav id="pages">
<label for="search">Search</label>
<input id="search" type="search" autocomplete="off">
<ul id="found" aria-live="polite"></ul>
{navigation}
</nav>
<script src="lunr.js"></script>
<script src="katex/katex.min.js"></script>
<script src="search.js"></script>
<script src="site.js"></script>
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
    # GitHub's forms of a formula: a block of "math", and code between dollars.
    body = re.sub(r'<pre><code class="language-math">(.*?)</code></pre>', r'<div class="math">\1</div>', body, flags=re.S)
    body = re.sub(r"\$<code>(.*?)</code>\$", r'<span class="math">\1</span>', body)
    # A table wider than a phone scrolls by itself and leaves the page where it is.
    body = body.replace("<table>", '<div class="table"><table>').replace("</table>", "</table></div>")
    return body, converter.toc_tokens


def title_of(root, page):
    return (root / page).read_text().split("\n", 1)[0].lstrip("# ")


def plain(text):
    return html.escape(text.replace("`", ""))


def sections_of(page, title, body):
    """What the search looks through: each part of a page below a heading of the first three levels."""
    for part in re.split(r"(?=<h[123] )", body):
        heading = re.match(r'<h[123] id="([^"]*)">(.*?)</h[123]>', part, re.S)
        words = html.unescape(re.sub(r"<[^>]*>", " ", part))
        if words.strip():
            named = html.unescape(re.sub(r"<[^>]*>", "", heading[2])) if heading else title
            yield {"page": name_of(page), "anchor": heading[1] if heading else "", "title": named, "of": title,
                   "text": " ".join(words.split())}


def navigation(titles, current, sections, interfaces):
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
        if chapter == "Extend" and interfaces:
            lines.append('<li><a href="interfaces/index.html">Interfaces in C and C++</a></li>')
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


def what_is_missing():
    """Debian packages."""
    missing = [f"libjs-{name}" for name in ("katex", "lunr") if not (LIBRARIES / name).is_dir()]
    try:
        import markdown  # noqa: F401
    except ImportError:
        missing.append("python3-markdown")
    return missing


def write_interfaces(root, out):
    """The pages that doxygen makes of the headers; False where there is no doxygen."""
    if shutil.which("doxygen") is None:
        print("scripts/docs: no doxygen: the site is without the pages of the interfaces", file=sys.stderr)
        return False
    folder = out / "interfaces"
    folder.mkdir(exist_ok=True)
    settings = (HERE / "Doxyfile").read_text() + (
        f"INPUT = {' '.join(INTERFACES)}\nOUTPUT_DIRECTORY = {folder.resolve()}\nSTRIP_FROM_PATH = {root}\n"
        f"STRIP_FROM_INC_PATH = {root / 'sdk/include'} {root / 'host'}\n")
    result = subprocess.run(["doxygen", "-"], input=settings, cwd=root, capture_output=True, text=True)
    if result.returncode != 0:
        raise SystemExit(f"scripts/docs: doxygen failed\n{result.stderr}")
    return True


def write(root, out):
    if missing := what_is_missing():
        print(f"scripts/docs: the site needs {', '.join(missing)}: apt-get install {' '.join(missing)}", file=sys.stderr)
        return 4
    out.mkdir(parents=True, exist_ok=True)
    interfaces = write_interfaces(root, out)
    titles = {page: title_of(root, page) for page in PAGES}
    searchable = []
    for place, page in enumerate(PAGES):
        body, tokens = rendered((root / page).read_text())
        step = {}
        for word, other in (("previous", place - 1), ("next", place + 1)):
            there = PAGES[other] if 0 <= other < len(PAGES) else None
            step[word] = f'<a class="{word}" href="{name_of(there)}">{plain(titles[there])}</a>' if there else ""
        searchable += sections_of(page, titles[page].replace("`", ""), body)
        text = PAGE.format(title=plain(titles[page]), navigation=navigation(titles, page, tokens, interfaces),
                           body=relinked(body, root, page, out), **step)
        (out / name_of(page)).write_text(text)
    for name in ("site.css", "site.js"):
        shutil.copyfile(HERE / name, out / name)
    shutil.copyfile(LIBRARIES / "lunr/lunr.min.js", out / "lunr.js")
    (out / "search.js").write_text(f"const searchable = {json.dumps(searchable)};\n")
    for name in ("katex.min.js", "katex.min.css", "fonts"):
        source, copy = LIBRARIES / "katex" / name, out / "katex" / name
        copy.parent.mkdir(exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, copy, dirs_exist_ok=True)
        else:
            shutil.copyfile(source, copy)
    print(out / "index.html")
    return 0

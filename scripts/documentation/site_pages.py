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
# A link that shows the name of the file that it leads to.
FILE_NAMED = re.compile(r'(<a href="([^"#:]*\.md)(?:#[^"]*)?">)(?:<code>)?[\w./-]+\.md(?:</code>)?</a>')
LINK = re.compile(r'(href|src)="([^"#:]*)(#[^"]*)?"')
PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<link rel="stylesheet" href="katex/katex.min.css">
<link rel="stylesheet" href="site.css">
</head>
<body class="{kind}">
<a class="skip" href="#text">To the text</a>
<nav>
<p class="home"><a href="index.html">Rouleau</a></p>
<label for="search">Search</label>
<input id="search" type="search" placeholder="Search" autocomplete="off">
<ul id="found" aria-live="polite"></ul>
<details id="pages" open><summary>All pages</summary>
{navigation}
</details>
</nav>
<main id="text">
{body}
<footer>{previous}{next}</footer>
</main>
{contents}
<script src="lunr.js"></script>
<script src="katex/katex.min.js"></script>
<script src="search.js"></script>
<script src="site.js"></script>
</body>
</html>
"""
# Who comes, and where they begin: the doors of the first page.
DOORS = {
    "I have a question about cells": ("Run it, change it, see it in ParaView and Python. Nothing is compiled but the program.",
        ["docs/first-run.md", "docs/first-run-3d.md", "docs/tutorial.md", "docs/scene.md", "docs/walls.md", "docs/gallery.md"]),
    "I write a model": ("A membrane law, a potential or a collision operator: two files outside of the program.",
        ["sdk/README.md", "docs/models.md", "docs/conformance.md", "docs/methods.md", "docs/library.md"]),
    "I check the numbers": ("Errors against exact solutions and experiments, and error bars for a run of your own.",
        ["docs/accuracy.md", "docs/experiments.md", "docs/error-bars.md", "docs/physics.md", "docs/study.md"]),
}
# Pictures that are drawn on white, in colours that stand for something: a dark page turns white into black and keeps the hues.
ON_WHITE = re.compile(r"\.svg$|/(?!rouleau-in-space|suspension-in-space|four-cells-in-space|three-dimensions)[\w.-]+\.(?:png|webp)$")


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
    body = re.sub(r"<pre><code(?: class=\"language-(\w+)\")?>(.*?)</code></pre>", coloured, body, flags=re.S)
    return re.sub(r"<table>.*?</table>", carded, body, flags=re.S), converter.toc_tokens


def coloured(block):
    """A block of code, coloured where its language is known: a scene without one begins with a bracket or a key."""
    from pygments import highlight, lexers
    from pygments.formatters import HtmlFormatter

    text = html.unescape(block[2])
    language = block[1] or ("json" if re.match(r'\s*[{\["]', text) else "cpp" if "#include" in text else "text")
    return f'<div class="code"><pre><code>{highlight(text, lexers.get_lexer_by_name(language), HtmlFormatter(nowrap=True))}</code></pre></div>'


def carded(table):
    """A table that can be read on a phone, where each row is a card and each cell names its column; long code breaks at its joints."""
    heads = [html.escape(html.unescape(re.sub(r"<[^>]*>", "", head)), quote=True) for head in re.findall(r"<th[^>]*>(.*?)</th>", table[0], re.S)]

    def row(cells):
        columns = iter(heads)
        return re.sub(r"<td([^>]*)>", lambda cell: f'<td{cell[1]} data-head="{next(columns, "")}">', cells[0])

    def breaking(text):
        return re.sub(r"\S{9,}", lambda word: re.sub(r"(?<=[/_,=.])(?=\w)", "<wbr>", word[0]), text[0])

    body = re.sub(r"<tr>.*?</tr>", row, table[0], flags=re.S)
    kind = "table many" if len(heads) > 6 else "table"
    return f'<div class="{kind}">{re.sub(r"(?<=>)[^<]+(?=<)", breaking, body)}</div>'


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


def navigation(titles, current, interfaces):
    lines = []
    for chapter, pages in CHAPTERS.items():
        lines.append(f"<details{' open' if current in pages else ''}><summary>{chapter}</summary><ul>")
        for page in pages:
            here = ' aria-current="page"' if page == current else ""
            lines.append(f'<li><a href="{name_of(page)}"{here}>{plain(titles[page]).split(":")[0]}</a></li>')
        if chapter == "Extend" and interfaces:
            lines.append('<li><a href="interfaces/index.html">Interfaces in C and C++</a></li>')
        lines.append("</ul></details>")
    return "\n".join(lines)


def contents(tokens):
    """What a page has, beside it: headings of the second level and the third."""
    def entries(these):
        return "".join(f'<li><a href="#{token["id"]}">{token["name"]}</a>{entries(token["children"])}</li>' for token in these).join(
            ("<ul>", "</ul>")) if these else ""

    tokens = [child for token in tokens for child in (token["children"] if token["level"] == 1 else [token])]
    if len(tokens) < 2:
        return "<aside></aside>"
    return f'<aside><details open><summary>On this page</summary>{entries(tokens)}</details></aside>'


def landing(body, titles):
    """README.md, with doors in place of its list of where to begin."""
    doors = ""
    for title, (words, pages) in DOORS.items():
        links = "".join(f'<li><a href="{name_of(page)}">{plain(titles[page]).split(":")[0]}</a></li>' for page in pages)
        doors += f"<section><h2>{title}</h2><p>{words}</p><ul>{links}</ul></section>"
    doors = f'<div class="doors">{doors}</div>'
    begin = re.search(r'<h2 id="where-to-begin">.*?(?=<h2 )', body, re.S)
    film = re.search(r"<p><img [^>]*></p>", body)
    return f"{body[:film.end()]}{doors}{body[film.end():begin.start()]}{body[begin.end():]}"


def relinked(body, root, page, out, titles):
    """Links to pages lead to their HTML, and show titles in place of file names; files of the source are copied beside it, folders
    only named."""
    def page_of(target):
        return os.path.normpath(os.path.join(os.path.dirname(page), target))

    def named(link):
        return f"{link[1]}{plain(titles[page_of(link[2])]).split(':')[0]}</a>" if page_of(link[2]) in PAGES else link[0]

    def picture(image):
        source = re.search(r'src="([^"]*)"', image[1])[1]
        return f'<img class="{"on-white" if ON_WHITE.search(source) else "own-ground"}" {image[1]}>'

    def one(match):
        attribute, target, anchor = match[1], match[2], match[3] or ""
        if not target:
            return match[0]
        path = page_of(target)
        if path in PAGES:
            return f'{attribute}="{name_of(path)}{anchor}"'
        if (root / path).is_file():
            copy = out / "files" / path
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(root / path, copy)
            return f'{attribute}="files/{path}{anchor}"'
        raise SystemExit(f"{page}: no file {target}")

    body = re.sub(r"<img ([^>]*)>", picture, FILE_NAMED.sub(named, body))
    return LINK.sub(one, body)


def what_is_missing():
    """Debian packages."""
    missing = [f"libjs-{name}" for name in ("katex", "lunr") if not (LIBRARIES / name).is_dir()]
    try:
        import markdown  # noqa: F401
    except ImportError:
        missing.append("python3-markdown")
    try:
        import pygments  # noqa: F401
    except ImportError:
        missing.append("python3-pygments")
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
        first = page == "README.md"
        body = relinked(body, root, page, out, titles)
        text = PAGE.format(title="Rouleau: red blood cells in flow" if first else f"{plain(titles[page])} - Rouleau",
                           kind="first" if first else "page", navigation=navigation(titles, page, interfaces),
                           contents="" if first else contents(tokens), body=landing(body, titles) if first else body, **step)
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

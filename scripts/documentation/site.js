// Typesets the formulas of a page, and searches all pages: lunr over search.js, which scripts/docs writes.
"use strict";

for (const formula of document.querySelectorAll(".math")) {
  katex.render(formula.textContent, formula, {displayMode: formula.tagName === "DIV", throwOnError: false});
}

const field = document.getElementById("search"), found = document.getElementById("found");
let index = null;

function sections() {
  index ??= lunr(function () {
    this.ref("number");
    this.field("title", {boost: 5});
    this.field("text");
    searchable.forEach((section, number) => this.add({number, ...section}));
  });
  // As the index has them: without the words that it leaves out, by their stems. The last word may still be incomplete.
  const words = lunr.tokenizer(field.value).map(lunr.trimmer).filter(word => word.toString() && lunr.stopWordFilter(word));
  if (!words.length) return [];
  const all = query => words.forEach((word, place) => query.term(lunr.stemmer(word).toString(), {
    presence: lunr.Query.presence.REQUIRED, usePipeline: false,
    wildcard: place === words.length - 1 ? lunr.Query.wildcard.TRAILING : lunr.Query.wildcard.NONE}));
  return index.query(all).slice(0, 12).map(result => searchable[result.ref]);
}

field.addEventListener("input", () => {
  found.replaceChildren(...sections().map(({page, anchor, title, of}) => {
    const item = document.createElement("li"), link = document.createElement("a"), place = document.createElement("small");
    link.href = page + (anchor ? "#" + anchor : "");
    link.textContent = title;
    place.textContent = of === title ? "" : " " + of;
    item.append(link, place);
    return item;
  }));
  if (field.value.trim() && !found.children.length) found.textContent = "Nothing found";
});

// Where there is little room, lists of pages and of sections open when they are asked for.
const narrow = matchMedia("(max-width: 62rem)"), middling = matchMedia("(max-width: 75rem)");
const contents = document.querySelector("aside details"), pages = document.getElementById("pages");
const fit = () => {
  pages.open = !narrow.matches;
  if (contents) contents.open = !middling.matches;
};
fit();
middling.addEventListener("change", fit);
narrow.addEventListener("change", fit);

// The section that is read is marked among the contents.
const entries = new Map([...document.querySelectorAll("aside a")].map(link => [decodeURIComponent(link.hash.slice(1)), link]));
const heads = [...document.querySelectorAll("main h2[id], main h3[id]")].filter(head => entries.has(head.id));
const mark = () => {
  const here = heads.findLast(head => head.getBoundingClientRect().top < 120) ?? heads[0];
  for (const [id, link] of entries) link.toggleAttribute("aria-current", id === here.id);
};
if (heads.length) {
  mark();
  addEventListener("scroll", mark, {passive: true});
}

// A button that copies a block of code. Pages from the disk have no clipboard of their own: then a selection is copied.
for (const block of document.querySelectorAll("main .code")) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = "Copy";
  button.setAttribute("aria-label", "Copy this block");
  button.addEventListener("click", async () => {
    const text = block.querySelector("code");
    if (navigator.clipboard) await navigator.clipboard.writeText(text.textContent);
    else {
      getSelection().selectAllChildren(text);
      document.execCommand("copy");
      getSelection().removeAllRanges();
    }
    button.textContent = "Copied";
    setTimeout(() => button.textContent = "Copy", 1500);
  });
  block.append(button);
}

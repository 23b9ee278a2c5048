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

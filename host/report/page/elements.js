// ---------------------------------------------------------------------------------------------- elements and numbers
const page = document.getElementById("page");

function element(name, attributes = {}, ...children) {
  const svg = ["svg", "g", "path", "line", "rect", "circle", "text", "tspan", "defs", "pattern", "clipPath"].includes(name);
  const node = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes))
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value); else node.setAttribute(key, value);
  node.append(...children);
  return node;
}
const raised = exponent => [...String(exponent)].map(c => c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)]).join("");
function format(value, digits = 4) {
  if (value === null || value === undefined) return "–";
  if (typeof value !== "number") return String(value);
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e9) return value.toLocaleString("en").replace(/,/g, "\u202f").replace("-", "−");
  if (size >= 1e6 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${Number(mantissa)} × 10${raised(Number(exponent))}`.replace("-", "−");
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}
// endings.json: [ending of a name, unit, unit in which it is drawn, how many of these are one]; the Python package has it, too.
const endingOf = name => endings.find(([ending]) => name.endsWith(ending) && !name.slice(0, -ending.length).endsWith("_per"));
const plainWords = name => name.replace(/^cell_free_/, "cell-free ").replace(/_/g, " ").replace(/^./, c => c.toUpperCase());
const wordsWithUnit = (name, ending, unit) => plainWords(name.slice(0, name.length - ending.length)) + (unit ? `, ${unit}` : "");
/// A name in words, with its unit.
const spelled = name => { const [ending, unit] = endingOf(name) ?? ["", ""]; return wordsWithUnit(name, ending, unit); };
/// The same for what is drawn: {title, factor}.
const drawnAs = name => { const [ending, , unit, factor] = endingOf(name) ?? ["", "", "", 1]; return {title: wordsWithUnit(name.replace("flow_rate_m2", "flow_rate_per_depth_m2"), ending, unit), factor}; };
/// Lists of what has the same key.
function grouped(list, key) {
  const groups = new Map();
  for (const one of list) { const k = key(one); if (!groups.has(k)) groups.set(k, []); groups.get(k).push(one); }
  return groups;
}
const seconds = t => t === undefined || t === null ? "–" : t < 120 ? `${format(t, 3)} s` : t < 7200 ? `${format(t / 60, 3)} min` : `${format(t / 3600, 3)} h`;
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
/// Tones of lines, cells and runs: any two differ for every kind of colour blindness (tests/browser measures it).
const lineTones = ["--c0", "--c1", "--c2", "--c3", "--c4", "--c5"];

/// A column is {title, number, and key or value (of a row, a text, number or node), mark (class of a cell)}. With
/// `stacked`, on a narrow screen every row becomes a list of its columns; with `sortable` a click on a title sorts by what
/// the column's `sort` (of a row; else key or value) gives, undefined ones last. `attributes(row)` are the row's.
function table(columns, rows, {stacked = false, sortable = false, fitting = false, attributes = () => ({})} = {}) {
  const valueOf = (c, row) => c.value ? c.value(row) : row[c.key];
  const trs = rows.map(row => element("tr", attributes(row), ...columns.map(c => {
    const value = valueOf(c, row);
    const cell = element("td", {"data-title": c.title, class: [c.number ? "number" : "", c.mark ? c.mark(row) : ""].join(" ").trim()});
    cell.append(value instanceof Node ? value : format(value));
    return cell;
  })));
  const body = element("tbody", {}, ...trs);
  const heads = columns.map(c => element("th", {scope: "col", ...(c.number ? {class: "number"} : {})}, c.title));
  if (sortable) heads.forEach((head, i) => {
    if (!columns[i].title) return;  // a column of pictures
    const of = rows.map(columns[i].sort ?? (row => valueOf(columns[i], row))), missing = v => v === null || v === undefined || v === "";
    head.replaceChildren(element("button", {type: "button", onclick: () => {
      const down = head.getAttribute("aria-sort") === "ascending", sign = down ? -1 : 1;
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const order = rows.map((_, row) => row).sort((a, b) => missing(of[a]) || missing(of[b]) ? missing(of[a]) - missing(of[b]) || a - b
        : sign * (typeof of[a] === "number" && typeof of[b] === "number" ? of[a] - of[b] : String(of[a]).localeCompare(String(of[b]), "en", {numeric: true})) || a - b);
      body.append(...order.map(row => trs[row]));
    }}, columns[i].title));
  });
  return element("div", {class: "card scroll" + (stacked ? " stacked" : "") + (sortable ? " sortable" : "") + (fitting ? " fitting" : "")},
    element("table", {}, ...(columns.some(c => c.title) ? [element("thead", {}, element("tr", {}, ...heads))] : []), body));
}

// Tables whose columns the host decides; the name of what a row is about comes first.
function freeTable(rows) {
  const keys = [...new Set(rows.flatMap(r => Object.keys(r)))].sort((a, b) => (b === "name") - (a === "name"));
  const numeric = key => rows.every(r => r[key] === null || r[key] === undefined || typeof r[key] === "number");
  return table(keys.map(key => ({title: spelled(key), number: numeric(key), value: r => typeof r[key] === "object" && r[key] !== null ? JSON.stringify(r[key]) : r[key]})), rows, {stacked: true});
}

/// Passes of a run with their times as bars, the longest first.
function passTable(passes) {
  const total = passes.reduce((sum, pass) => sum + (pass.wall_s || 0), 0) || 1, counted = passes.some(pass => pass.calls !== undefined);
  return table([{title: "Pass", key: "name"}, {title: "Time", number: true, value: r => seconds(r.wall_s)},
    {title: "Share", number: true, value: r => `${(100 * r.wall_s / total).toFixed(1)} %`},
    {title: "", value: r => element("span", {class: "share", style: `width:${(110 * r.wall_s / total).toFixed(0)}px`})},
    ...(counted ? [{title: "Calls", key: "calls", number: true}, {title: "Each", number: true, value: r => r.calls ? `${format(1e6 * r.wall_s / r.calls, 3)} µs` : "–"}] : [])],
    [...passes].sort((a, b) => b.wall_s - a.wall_s), {stacked: true});
}

function warningBox(warnings, whose = "", headline = warnings.length === 1 ? "Warning" : `${warnings.length} warnings`) {
  return element("div", {class: "card status warn"}, element("strong", {}, headline + whose), element("ul", {}, ...warnings.map(w => element("li", {}, w))));
}
const note = text => element("p", {class: "quiet"}, text);

// Sections, and the links to them that stay at the top of the window.
const links = element("nav", {"aria-label": "Sections"});
let place = page;  // where sections go: the page, or a tab of it
function section(title, ...content) {
  const id = title.toLowerCase().replace(/[^a-z]+/g, "-");
  if (place === page) links.append(element("a", {href: `#${id}`}, title));
  place.append(element("h2", {id}, title), ...content);
}

/// Tabs of sections, {title, mark (a word beside the title), fill (adds the sections)}; those without any are left out.
function tabs(list) {
  const bar = element("div", {role: "tablist", "aria-label": "Tables"}), panels = [];
  for (const {title, mark, fill} of list) {
    const id = `tab-${title.toLowerCase()}`, panel = element("div", {role: "tabpanel", id, "aria-label": title});
    place = panel;
    fill();
    place = page;
    if (!panel.children.length) continue;
    const tab = element("button", {type: "button", role: "tab", "aria-controls": id, onclick: () => show(tab)}, title, ...(mark ? [element("span", {class: `mark ${mark.kind}`}, mark.text)] : []));
    bar.append(tab);
    panels.push(panel);
  }
  const show = chosen => {
    [...bar.children].forEach((tab, i) => { tab.setAttribute("aria-selected", String(tab === chosen)); tab.tabIndex = tab === chosen ? 0 : -1; panels[i].classList.toggle("closed", tab !== chosen); });
  };
  bar.addEventListener("keydown", event => {
    const all = [...bar.children], step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
    if (!step) return;
    const next = all[(all.indexOf(document.activeElement) + step + all.length) % all.length];
    show(next);
    next.focus();
    event.preventDefault();
  });
  if (!panels.length) return;
  section("Details", bar, ...panels);
  show(bar.firstChild);
}

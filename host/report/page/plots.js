// ------------------------------------------------------------------------------------ which charts a run or two have
const runNames = [..."ABCDEFGHIJKLMNOPQRSTUVWXYZ"], runTones = runNames.map((_, i) => lineTones[i % lineTones.length]);
const mostLines = 6;  // of cells in a chart: beyond these their median and spread

/// Order and looks of the charts that the run's data lists; what is not named here comes last among `more`. `group` is
/// where a chart stands: "main" (the four first of these are open), "more", or "numerics".
const looks = {
  "Aggregates, single cells included": {steps: true, whole: true, zero: true, needsCells: 2, group: "main"},
  "Smallest gap to another cell": {zero: true, needsCells: 2, group: "main"},
  "Deformation (L − B)/(L + B)": {group: "main"},
  "Relative viscosity": {group: "main"},
  "Cells": {steps: true, zero: true, optional: true, group: "main"},
  "Cell-free layer": {zero: true, needsCells: 1, optional: true, group: "main"},
  "Angle of the long axis": {group: "main"},
  "Smallest gap to a wall": {zero: true, optional: true},
  "Aggregate size, mean over cells": {steps: true, zero: true, needsCells: 2},
  "Particle stress xy": {needsCells: 1},
  "Energy of the cells": {needsCells: 1, optional: true},
  "Power": {optional: true},
  "Largest Mach number": {zero: true, group: "numerics"},
  "Largest relative area drift": {zero: true, needsCells: 1, group: "numerics"},
  "Largest area kept from leaking, relative": {zero: true, needsCells: 1, optional: true, group: "numerics"},
  "Relative mass drift": {zero: true, group: "numerics"},
  "Kinetic energy of the fluid as simulated": {optional: true, group: "numerics"},
};

/// What charts of aggregates show where nothing joins cells that are close.
const withoutAttraction = {"Aggregates, single cells included": "Groups of close cells, single cells included", "Aggregate size, mean over cells": "Size of groups of close cells, mean over cells"};

/// The charts of a page, each {title, unit, table, lines: [{name, label, doc}], and its looks}.
function quantitiesOf(data) {
  const titles = Object.keys(looks), place = chart => { const i = titles.indexOf(chart.title); return i < 0 ? titles.length : i; };
  return data.charts.map(chart => ({...chart, ...looks[chart.title]})).sort((a, b) => place(a) - place(b))
    .map(chart => chart.title !== "Cell-free layer" || layersAreThere(data.summary?.rheology?.at(-1)?.means) ? chart : {...chart, group: "more"})
    .map(chart => attracts(data) || !withoutAttraction[chart.title] ? chart : {...chart, title: withoutAttraction[chart.title], group: "more"});
}

/// The median of all cells and the ends of the middle 80 % of them, by output.
function spreadOfCells(run, name) {
  const lines = run.cells[name], at = share => run.step.map((_, i) => { const values = lines.map(line => line[i]).filter(v => v !== null); return values.length ? percentile(values, share) : null; });
  return {low: at(.1), median: at(.5), high: at(.9)};
}

/// A quantity may make sense with so many cells alone.
const enoughCells = ({needsCells = 0, table}, runs) => runs.some(run => (run.cells?.types.length ?? 0) >= (needsCells || (table === "cells" ? 1 : 0)));

/// Lines of a quantity: of one run each cell's, of many cells or several runs their median and range.
function linesOf(quantity, runs) {
  if (!enoughCells(quantity, runs)) return [];
  const several = runs.length > 1;
  return runs.flatMap((run, r) => {
    const prefix = several ? `${runNames[r]} ` : "", dashed = several && r % 2 === 1;
    if (quantity.table === "cells") {
      const [{name}] = quantity.lines, cells = run.cells?.[name];
      if (!cells) return [];
      if (several || cells.length > mostLines) {
        const {low, median, high} = spreadOfCells(run, name), tone = several ? runTones[r] : "--c0", single = cells.length === 1;
        return [{label: `${prefix}${single ? "" : "median"}`.trim(), values: median, run: r, tone, dashed},
          ...(single || runs.length > 2 ? [] : [{label: `${prefix}middle 80 %`, values: high, band: low, run: r, tone}]),
          ...(several ? [] : [{label: "", values: median.map(() => null), run: r, tone: "--c1", picked: true}])];
      }
      return cells.map((values, i) => ({values, run: r, tone: lineTones[i], label: `cell ${cellNumber(run, i)}`, cell: i}));
    }
    const there = quantity.lines.filter(({name}) => run.series[name]);
    return there.map(({name, label}, i) => ({values: run.series[name], run: r, dashed, label: (prefix + label).trim(), tone: several && there.length === 1 ? runTones[r] : lineTones[i % lineTones.length]}));
  }).filter(line => line.picked || line.values.some(v => v !== null));
}

/// Small numbers are shown in a smaller unit, or as a multiple of a power of ten: {unit, factor}.
function readable(unit, lines) {
  const largest = Math.max(...lines.flatMap(line => [...line.values, ...(line.band || [])]).map(v => Math.abs(v ?? 0)));
  const power = Math.ceil(-Math.log10(largest) / 3);  // of a thousand
  if (!(largest < (unit ? 0.1 : 1e-4)) || largest === 0) return {unit, factor: 1};
  const prefix = unit && ["", "m", "µ", "n", "p", "f", "a"][power];
  return {unit: prefix ? prefix + unit : `10${raised(-3 * power)}${unit ? " " + unit : ""}`, factor: 10 ** (3 * power)};
}
const multiplied = (values, factor) => factor === 1 || !values ? values : values.map(v => v === null ? null : v * factor);

/// Draws all charts that have something to show, four of them open; returns why the others are missing, in sentences.
function plots(timeline, parent, {view, events = []}) {
  const missing = [], zero = [], grids = {}, open = 4;
  const grid = name => grids[name] ??= element("div", {class: "charts" + (name === "main" ? " main" : "")});
  for (const quantity of quantitiesOf(timeline.runs.find(run => !attracts(run)) ?? timeline.runs[0])) {
    const lines = linesOf(quantity, timeline.runs);
    if (!lines.some(line => !line.picked)) { if (!quantity.optional && enoughCells(quantity, timeline.runs)) missing.push(quantity.title); continue; }
    // An axis up to 1 would speak of a size that is not there.
    if (!quantity.whole && lines.every(line => line.values.every(v => !v))) { zero.push(quantity.title); continue; }
    const {unit, factor} = readable(quantity.unit, lines);
    for (const line of lines) { line.values = multiplied(line.values, factor); if (line.band) line.band = multiplied(line.band, factor); }
    const about = quantity.lines.map(({label, doc}) => `${label ? `${label}: ` : ""}${doc.replaceAll("`", "")}`).join("\n");
    const group = quantity.group === "main" && grid("main").children.length >= open ? "more" : quantity.group ?? "more";
    const chart = new Chart(grid(group), timeline, {...quantity, about, unit, lines, events}), name = quantity.lines[0].name;
    if (quantity.table === "cells" && timeline.runs.length === 1) view?.listeners.push(() => chart.pick(view.lifted, cell => multiplied(timeline.runs[0].cells[name][cell], factor), cellNumber(timeline.runs[0], view.lifted)));
  }
  parent.append(...(grids.main ? [grids.main] : []));
  for (const [name, title] of [["more", "More charts"], ["numerics", "Numerics: Mach number, drifts, energy of the simulated fluid"]])
    if (grids[name]) parent.append(element("details", {class: "folded", ontoggle: () => { for (const chart of charts) { chart.resize(); chart.follow(); } }}, element("summary", {}, title), grids[name]));
  const listed = list => list.join(", ").toLowerCase().replace(/\bmach\b/g, "Mach"), notes = [];
  if (missing.length) notes.push(`Not shown, because undefined at every output: ${listed(missing)}.`);
  if (zero.length) notes.push(`Not shown, because zero at every output: ${listed(zero)}.`);
  return notes;
}

/// The choice of the horizontal axis, if there is one, and the way back from a stretch of it.
function axisControls(timeline) {
  const controls = element("div", {class: "controls"});
  const choices = [...(timeline.runs.length === 1 && timeline.stages.length > 1 ? [["stages", "stage by stage"]] : []), ...(timeline.sheared ? [["strain", "over strain"]] : []), ["time_s", "over time"]];
  if (choices.length > 1) {
    const select = element("select", {"aria-label": "Horizontal axis", onchange: () => { timeline.setOver(select.value); zoomed = null; redrawCharts(); timeline.seek(timeline.position); document.dispatchEvent(new Event("zoomed")); }},
      ...choices.map(([value, text]) => element("option", {value}, text)));
    select.value = timeline.over;
    controls.append(element("label", {}, "Axis", select));
  }
  const all = element("button", {type: "button", hidden: "", onclick: () => zoom(null)}, "Show all");
  document.addEventListener("zoomed", () => { all.hidden = !zoomed; });
  controls.append(all);
  return controls;
}

// ------------------------------------------------------------------------------------ which charts a run or two have
const cellTones = ["--c0", "--c1", "--c2", "--c3", "--c4", "--c5", "--c6", "--c7", "--c0", "--c1", "--c2", "--c3"];
const runTones = ["--c0", "--c1"], runNames = ["A", "B"];

/// Order and looks of the charts that the run's data lists; what is not named here comes last, as it is.
const looks = {
  "Aggregates (lone cells count)": {steps: true, whole: true, zero: true, needsCells: true, first: true},
  "Smallest gap to another cell": {zero: true},
  "Deformation (L − B)/(L + B)": {},
  "Angle of the long axis": {},
  "Relative viscosity": {},
  "Largest relative area drift": {zero: true, needsCells: true},
  // The fluid's kinetic energy is often a hundred times that of the cells, and would hide it.
  "Energy of the cells": {needsCells: true, optional: true},
  "Energy in all": {optional: true},
  "Power": {optional: true},
  "Layers without cells": {zero: true, needsCells: true, optional: true},
  "Aggregate size, mean over cells": {steps: true, zero: true, needsCells: true},
  "Particle stress xy": {needsCells: true},
  "Largest Mach number": {zero: true},
  "Largest area kept from leaking, relative": {zero: true, needsCells: true, optional: true},
  "Relative mass drift": {zero: true},
};

/// The charts of a page, each {title, unit, table, lines: [{name, label, doc}], and its looks}.
function quantitiesOf(data) {
  const titles = Object.keys(looks), place = chart => { const i = titles.indexOf(chart.title); return i < 0 ? titles.length : i; };
  return data.charts.map(chart => ({...chart, ...looks[chart.title]})).sort((a, b) => place(a) - place(b));
}

function smallestMeanLargest(run, name) {
  const lines = run.cells[name];
  if (run.cells.labels[0] === "smallest") return lines;
  return [Math.min, null, Math.max].map(pick => run.step.map((_, i) => {
    const values = lines.map(line => line[i]).filter(v => v !== null);
    return !values.length ? null : pick ? pick(...values) : values.reduce((a, b) => a + b) / values.length;
  }));
}

/// Lines of a quantity: of one run each cell's, of two runs each run's mean and range.
function linesOf(quantity, runs) {
  if (quantity.needsCells && !runs.some(run => run.cells)) return [];
  const two = runs.length > 1;
  return runs.flatMap((run, r) => {
    const prefix = two ? `${runNames[r]} ` : "";
    if (quantity.table === "cells") {
      const [{name}] = quantity.lines;
      if (!run.cells) return [];
      if (two) {
        const [low, mean, high] = smallestMeanLargest(run, name);
        return [{label: `${prefix}mean`, values: mean, run: r, tone: runTones[r], dashed: r === 1},
                {label: `${prefix}range`, values: high, band: low, run: r, tone: runTones[r]}];
      }
      const summed = run.cells.labels[0] === "smallest";
      return run.cells[name].map((values, i) => ({values, run: r, tone: summed ? ["--c5", "--c0", "--c1"][i] : cellTones[i],
        label: run.cells.labels[i].replace(/ \(.*/, "")}));
    }
    const there = quantity.lines.filter(({name}) => run.series[name]);
    return there.map(({name, label}, i) => ({values: run.series[name], run: r, dashed: r === 1,
      label: (prefix + label).trim(), tone: two && there.length === 1 ? runTones[r] : cellTones[i]}));
  }).filter(line => line.values.some(v => v !== null));
}

/// Small numbers are told in a smaller unit, or as a multiple of a power of ten: {unit, factor}.
function readable(unit, lines) {
  const largest = Math.max(...lines.flatMap(line => [...line.values, ...(line.band || [])]).map(v => Math.abs(v ?? 0)));
  const power = Math.ceil(-Math.log10(largest) / 3);  // of a thousand
  if (!(largest < (unit ? 0.1 : 1e-4)) || largest === 0) return {unit, factor: 1};
  const prefix = unit && ["", "m", "µ", "n", "p", "f", "a"][power];
  return {unit: prefix ? prefix + unit : `10${raised(-3 * power)}${unit ? " " + unit : ""}`, factor: 10 ** (3 * power)};
}
const multiplied = (values, factor) => factor === 1 || !values ? values : values.map(v => v === null ? null : v * factor);

/// Draws all charts that have something to show; returns why the others are missing, in sentences.
function plots(timeline, first, grid) {
  const missing = [], zero = [];
  for (const quantity of quantitiesOf(timeline.runs[0])) {
    const lines = linesOf(quantity, timeline.runs), parent = quantity.first ? first : grid;
    if (!lines.length) { if (!quantity.optional && !(quantity.needsCells || quantity.table === "cells") || (!quantity.optional && timeline.runs.some(run => run.cells))) missing.push(quantity.title); continue; }
    // An axis up to 1 would speak of a size that is not there.
    if (!quantity.whole && lines.every(line => line.values.every(v => !v))) { zero.push(quantity.title); continue; }
    const {unit, factor} = readable(quantity.unit, lines);
    for (const line of lines) { line.values = multiplied(line.values, factor); if (line.band) line.band = multiplied(line.band, factor); }
    const beside = quantity.first && timeline.runs.length === 1;  // the animation
    const about = quantity.lines.map(({label, doc}) => `${label ? `${label}: ` : ""}${doc.replaceAll("`", "")}`).join("\n");
    new Chart(parent, timeline, {...quantity, about, unit, lines, wide: beside, height: beside && innerWidth > 800 ? 290 : 180});
  }
  const listed = list => list.join(", ").toLowerCase().replace(/\bmach\b/g, "Mach");
  const notes = [];
  if (missing.length) notes.push(`Not shown, because undefined at every output: ${listed(missing)}.`);
  if (zero.length) notes.push(`Not shown, because zero at every output: ${listed(zero)}.`);
  return notes;
}

/// The choice of the horizontal axis, if there is one, and the way back from a stretch of it.
function axisControls(timeline) {
  const controls = element("div", {class: "controls"});
  const choices = [...(timeline.sheared ? [["strain", "over strain"]] : []), ["time_s", "over time"], ...(timeline.runs.length === 1 ? [["output", "over outputs"]] : [])];
  if (choices.length > 1) {
    const select = element("select", {"aria-label": "Horizontal axis", onchange: () => { timeline.setOver(select.value); zoomed = null; redrawCharts(); timeline.seek(timeline.position); document.dispatchEvent(new Event("zoomed")); }},
      ...choices.map(([value, text]) => element("option", {value}, text)));
    controls.append(element("label", {}, "Charts", select));
  }
  const all = element("button", {type: "button", hidden: "", onclick: () => zoom(null)}, "Show all");
  document.addEventListener("zoomed", () => { all.hidden = !zoomed; });
  controls.append(all);
  return controls;
}

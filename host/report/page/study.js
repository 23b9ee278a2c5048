// ------------------------------------------------------------------------------------------------------ the page of a study
/// A sentence of study.json as it is set: "±" for "+-", "2 × 10⁻⁵" for "2e-05".
const typeset = text => text.replaceAll("+-", "±").replace(/(?<![\w.])(\d+(?:\.\d+)?)e([-+]?\d+)\b/g, (_, mantissa, exponent) => `${mantissa} × 10${raised(Number(exponent))}`);

function studyWarnings(study, view) {
  const failed = view.points.filter(p => p.status !== "completed").length, left = study.left_out ?? [];
  return [
    ...(study.complete === false && !left.length ? ["The study is not finished; the same command continues it."] : []),
    ...view.quantities.map(q => q.disagreement && (q.disagreement.includes(q.name) ? typeset(q.disagreement) : `${q.name}: ${typeset(q.disagreement)}`)),
    ...view.quantities.map(q => q.reference?.why_not && `${typeof q.reference.value === "number" ? `The reference of ${q.name} is uncertain` : `There is no reference for ${q.name}`}: ${q.reference.why_not}`),
    ...view.points.map(p => p.not_deterministic && `not deterministic: ${labelWords(p.labels)}: ${p.not_deterministic}`),
    ...(failed ? [`${failed} of ${view.points.length} points failed. They are drawn at the upper border of the charts, and a table lists them.`] : []),
    ...(left.length ? [`${left.length} ${left.length === 1 ? "point was" : "points were"} left out; the table at the end says which and why.`] : [])].filter(Boolean);
}

function sentenceBox(view) {
  const {study} = view, find = (quantity, id) => id === null || id === undefined ? "" : element("button", {type: "button", class: "find", onclick: () => {
    view.quantity = view.quantities.find(q => q.name === quantity) ?? view.quantity;
    view.choose(id);
    document.querySelector(".scatter:not([hidden])")?.scrollIntoView({block: "center"});
  }}, "show");
  // Where methods disagree is told among the warnings.
  const told = (study.sentences ?? []).filter(s => !view.quantities.some(q => q.disagreement === s.text));
  const lines = told.map(s => element("li", {}, ...(s.text.includes(s.quantity) ? [] : [element("b", {}, s.quantity), ": "]), typeset(s.text), " ", find(s.quantity, s.point)));
  if (!lines.length) lines.push(element("li", {}, "There is no conclusion yet: see the charts and tables."));
  return element("div", {class: "card status sentences"}, element("ul", {}, ...lines));
}

function showStudy(study) {
  const view = new StudyView(study), title = study.title || "Untitled study";
  document.title = `${title} – Rouleau`;
  const completed = view.points.filter(p => p.status === "completed").length;
  page.append(element("h1", {}, title), note([study.study_file, `${completed} of ${view.points.length} points completed`, study.started, study.machine?.cpu].filter(Boolean).join(" · ")), sentenceBox(view));
  const warnings = studyWarnings(study, view);
  if (warnings.length) page.append(warningBox(warnings));
  page.append(links);
  if (view.points.length && view.quantity) {
    showStudyCharts(view);
    showReferences(view);
    showKnobs(view);
    showPoints(view);
    showFailures(view);
    showPasses(view);
  } else section("Results", element("p", {}, view.points.length ? "The points have been run, but study.json has no quantity of them." : "No point has been run."));
  if ((study.left_out ?? []).length) section("Points that were left out", element("details", {}, element("summary", {}, `${study.left_out.length} ${study.left_out.length === 1 ? "point" : "points"}, and why`), table([{title: "Point", value: r => labelWords(r.labels ?? {})}, {title: "Why", key: "why"},
    {title: "Estimated time", number: true, value: r => seconds(r.estimated_s)}], study.left_out, {stacked: true})));
  showOrigin(study, study.study_file, "Study");
  footer(programOf(study), "This page shows one study; all that it draws is in it.", study.study_file ? `rouleau study ${study.study_file}` : null, "with the file of the study");
  view.changed();
  return view;
}
const data = JSON.parse(document.getElementById("data").textContent);
const view = showStudy(data);

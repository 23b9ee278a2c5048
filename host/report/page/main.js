// ------------------------------------------------------------------------------------------------------------ the page
const data = JSON.parse(document.getElementById("data").textContent);
for (const run of data.runs ?? [data]) fillLines(run);
const timeline = data.runs ? showComparison(data) : showRun(data);
redraws.push(redrawCharts, () => { if (timeline?.count) timeline.seek(timeline.position); });
addEventListener("hashchange", () => { if (timeline?.count) followLink(timeline); });
addEventListener("beforeprint", () => timeline?.stop());

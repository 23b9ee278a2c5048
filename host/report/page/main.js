// ------------------------------------------------------------------------------------------------------------ the page
const data = JSON.parse(document.getElementById("data").textContent);
const timeline = data.runs ? showComparison(data) : showRun(data);
redraws.push(redrawCharts, () => timeline?.seek(timeline.position));

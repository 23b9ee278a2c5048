// ------------------------------------------------------------------------------------------------ colours, and the paper
// What is drawn to measure or on a canvas knows nothing of style sheets: it is drawn again where the colours change, and
// for the paper.
let printing = false, closed = [];
const redraws = [];
function redrawAll() { for (const redraw of redraws) redraw(); }

function onPaper(paper) {
  if (printing === paper) return;
  printing = paper;
  document.documentElement.classList.toggle("paper", paper);
  if (paper) { closed = [...document.querySelectorAll("details:not([open])")]; }
  for (const details of closed) details.open = paper;
  redrawAll();
}
addEventListener("beforeprint", () => onPaper(true));
addEventListener("afterprint", () => onPaper(false));
matchMedia("print").addEventListener("change", e => onPaper(e.matches));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redrawAll);

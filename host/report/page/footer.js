// ------------------------------------------------------------------------------------------------ who made this page, and how
/// The version of the program in a result: "0.2.0-b7833054" of a summary.
const programOf = result => result?.git ?? result?.program ?? "";
/// How to cite the program, as BibTeX.
function bibtex(program) {
  const version = program.replace(/-.*/, "");
  return `@software{rouleau,\n  title = {Rouleau: red blood cells that deform, flow and attract each other},\n  author = {{The Rouleau developers}},\n  version = {${version}},\n  note = {${program ? `build ${program}, ` : ""}MIT licence}\n}`;
}
function copyButton(text, label) {
  const pressed = element("button", {type: "button", class: "small", "aria-label": `copy ${label}`, onclick: () => {
    const done = words => { pressed.textContent = words; setTimeout(() => { pressed.textContent = "Copy"; }, 1500); };
    if (navigator.clipboard) navigator.clipboard.writeText(text).then(() => done("Copied"), () => done("Select it")); else done("Select it");
  }}, "Copy");
  return pressed;
}
/// `command` makes the same again, from files that `from` says where to find; buttons stand `beside` it, and `more` at the end.
function footer(program, what, command, from, beside = [], ...more) {
  const code = (text, label, ...besides) => element("div", {class: "take"}, element("pre", {tabindex: 0}, text), copyButton(text, label), ...besides);
  page.append(element("footer", {}, element("p", {}, "Made with ", element("b", {}, `Rouleau ${program}`.trim()), `, a free simulator of red blood cells that deform, flow and attract each other. ${what} It needs no network.`),
    ...(command ? [element("p", {}, `To run it again (${from}):`), code(command, "the command", ...beside)] : []),
    element("details", {}, element("summary", {}, "To cite the program (BibTeX)"), code(bibtex(program), "the citation")), ...more));
}

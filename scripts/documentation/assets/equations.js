// Equations by KaTeX: pymdownx.arithmatex writes them as \(..\) and \[..\] in elements of this class.
// An equation that has no room for its number is moved to the left, then made smaller, then scrolls.
const GAP = 16;          // px between an equation and its number
const SMALLEST = 75;     // %

function fit(element) {
  const display = element.querySelector(".katex-display"), line = element.querySelector(".katex-display > .katex > .katex-html");
  const tag = line && line.querySelector(":scope > .tag");
  if (!tag) return;
  const katex = display.querySelector(":scope > .katex");
  const width = () => [...line.querySelectorAll(":scope > .base")].reduce((sum, part) => sum + part.getBoundingClientRect().width, 0);
  const label = () => tag.getBoundingClientRect().width + GAP;
  katex.style.minWidth = katex.style.textAlign = display.style.fontSize = "";
  const room = display.clientWidth;
  if (width() + 2 * label() <= room) return;
  katex.style.textAlign = "left";
  for (let size = 100; size >= SMALLEST && width() + label() > room; size -= 5) display.style.fontSize = `${size}%`;
  if (width() + label() > room) katex.style.minWidth = `${Math.ceil(width() + label())}px`;
}

const equations = document.querySelectorAll(".arithmatex");
equations.forEach((element) => renderMathInElement(element, {
  delimiters: [{ left: "\\(", right: "\\)", display: false }, { left: "\\[", right: "\\]", display: true }],
  throwOnError: true,
}));
const fitAll = () => {
  equations.forEach(fit);
  document.documentElement.dataset.equations = "ready";
};
document.fonts.ready.then(fitAll);
addEventListener("resize", fitAll);

// Equations by KaTeX: pymdownx.arithmatex writes them as \(..\) and \[..\] in elements of this class.
document.querySelectorAll(".arithmatex").forEach((element) => renderMathInElement(element, {
  delimiters: [{ left: "\\(", right: "\\)", display: false }, { left: "\\[", right: "\\]", display: true }],
  throwOnError: true,
}));

// The page: which figures and sections there are, in their order.

// Drawn by the program; every other kind is drawn here too, to be zoomed and read out.
const STILL = ["xy", "map", "scatter", "bars", "parallel"];
const DRAWN = { piston_bars: barsFigure, drawing: drawingFigure, bands: bandsFigure };

// A figure may bring curves of its own, at angles of its own.
const dataOf = (figure, report, data) => !figure.curves ? data
  : { ...prepare(report, figure.curves), mounts: data.mounts };

function figures(report, data) {
  const figures = list(report.figures).filter(f => f.curves || ["drawing", "bands"].includes(f.kind) || STILL.includes(f.kind) || data.order.length);
  if (!figures.length) return null;
  return el("div", {},
    figures.some(f => !STILL.includes(f.kind)) ? el("p.hint", {}, "Drag along a plot to zoom the angle, up or down to zoom the value; "
      + "double-click to see all again. Point at a curve to read the values in the table above it.") : null,
    data.samples ? el("p.hint", { id: "samples" }, `The curves show ${data.theta.length} of ${data.samples} samples: evenly spread ones, and `
      + "those at which a curve is smallest or largest. The CSV files have all of them.") : null,
    figures.map(f => {
      const own = dataOf(f, report, data), still = STILL.includes(f.kind);
      const picture = el("div.picture" + (still ? ".still" : ""));
      picture.append(document.querySelector(`#pictures [data-figure="${f.id}"] svg`).cloneNode(true));
      return el("figure", { id: "figure-" + f.id }, el("figcaption", {}, el("h3", {}, f.title),
        f.paper ? el("span.paper", {}, "paper: " + f.paper) : null, handOut(f, own, picture)),
        still ? null : el("div.screen", {}, (DRAWN[f.kind] || curvesFigure)(f, own)),
        picture, f.note ? el("p.note", {}, f.note) : null);
    }));
}

// What is found, what it is about, what an engineer asks first; then the numbers behind it, the curves, and where all
// comes from.
const SECTIONS = [
  ["verdict", "Verdict", verdictBanner], ["warnings", "Warnings", warnings], ["pump", "Pump", pumpHead],
  ["space", "The pump in three dimensions", (report, data) => pumpInSpace(report, data, data.scene)],
  ["key", "Key figures", keyFigures], ["summary", "Summary", summary],
  ["comparison", "Comparison", comparison], ["assumptions", "Assumptions", assumptionSplit],
  ["validity", "Validity over the turn", validity], ["timing", "Timing of the ports", timing],
  ["budget", "Torque, power and efficiency", budget], ["published", "Against the published numbers", published],
  ["figures", "Figures", figures], ["runs", "Results in tables", runs],
  ["checks", "Checks of each model", checks], ["common", "Common to both models", commonInputs],
  ["case", "Case", caseTable], ["derived", "Derived quantities", derived],
  ["models", "How each model was obtained", models], ["versions", "Origin and versions", versions],
];

// What a turn or a motion of one pump gives has key figures, and the pump comes before them. In a study the pump comes last.
// Of many pumps there are no curves of one: their tables come first. Of one pump computed in many ways (rows) the figures do.
function sectionsOf(report, data) {
  if (report.key_figures) return SECTIONS;
  const of = (...ids) => SECTIONS.filter(([id]) => ids.includes(id));
  const first = of("verdict", "warnings"), pump = of("pump", "space");
  const tables = data.theta.length > 0 || report.rows ? [] : of("runs");
  const rest = SECTIONS.filter(s => ![...first, ...pump, ...tables].includes(s));
  const place = rest.findIndex(([id]) => id === "figures");
  const end = rest.findIndex(([id]) => id === "case");
  return [...first, ...rest.slice(0, place), ...tables, ...rest.slice(place, end), ...pump, ...rest.slice(end)];
}

function header(report, data) {
  const { theta, tables } = data, n = theta.length, all = data.samples || n;
  const angles = n === 0 ? null : !data.axis.angle ? `${all} rows, ${data.axis.label} ${number(theta[0])} to ${number(theta[n - 1])}` : n === 1 ? "1 angle, " + degrees(theta[0])
    : `${all} angles from ${degrees(theta[0])} to ${degrees(theta[n - 1])}`;
  const parts = [report.case && report.case.file, tables.map(t => t.name).join(" and "), angles,
                 list(list(report.program)[0]).join(" ")];
  return [el("h1", {}, report.title || document.title),
          report.plausibility ? el("p.pump-line", {}, report.plausibility.summary) : null,
          el("p", {}, parts.filter(Boolean).map(p => el("span", {}, p)))].filter(Boolean);
}

// Scrolls the contents alone: scrollIntoView would move the page too.
function keepInSight(link, box) {
  const at = link.getBoundingClientRect(), frame = box.getBoundingClientRect();
  if (at.top < frame.top) box.scrollTop -= frame.top - at.top + 40;
  if (at.bottom > frame.bottom) box.scrollTop += at.bottom - frame.bottom + 40;
}

// Contents that stay: beside the report where there is room, else a bar on top that says where the reader is and opens.
function contents(sections, report) {
  const link = (id, text, inner) => el("li", {}, el("a", { href: "#" + id }, text), inner);
  const inner = id => id === "figures" ? el("ul", {}, report.figures.map(f => link("figure-" + f.id, f.title)))
    : id === "runs" && report.runs.length > 1 ? el("ul", {}, report.runs.map((r, i) => link("table-" + (i + 1), r.title))) : null;
  const where = el("span.where");
  const folding = el("details", {}, el("summary", {}, "Contents", where),
    el("ul", {}, sections.map(s => link(s.id, s.title, inner(s.id)))));
  const wide = matchMedia("(min-width: 1100px)");
  const fold = () => { folding.open = wide.matches; };
  wide.addEventListener("change", fold);
  fold();
  const links = new Map([...folding.querySelectorAll("a")].map(a => [a.getAttribute("href").slice(1), a]));
  folding.addEventListener("click", e => { if (e.target.closest("a") && !wide.matches) folding.open = false; });
  folding.addEventListener("keydown", e => {
    if (e.key !== "Escape" || wide.matches || !folding.open) return;
    folding.open = false;
    folding.firstChild.focus();
  });
  const watcher = new IntersectionObserver(entries => {
    entries.forEach(e => {
      const a = links.get(e.target.id);
      if (e.isIntersecting) a.setAttribute("aria-current", "true"); else a.removeAttribute("aria-current");
    });
    const here = [...links.values()].filter(a => a.hasAttribute("aria-current")).pop();
    if (here) where.textContent = here.textContent;
    if (here && wide.matches) keepInSight(here, folding.parentElement);
  }, { rootMargin: "-15% 0px -80% 0px" });
  links.forEach((_, id) => watcher.observe(document.getElementById(id)));
  return folding;
}

function render() {
  const read = id => JSON.parse(document.getElementById(id).textContent);
  cursors = new Map();
  const report = read("report"), data = prepare(report, read("curves") || {});
  data.scene = document.getElementById("scene") && read("scene");
  document.getElementById("head").replaceChildren(...header(report, data));
  const main = document.getElementById("main"), notices = document.getElementById("notices");
  main.replaceChildren();
  startDrawing();
  const shown = [];
  for (const [id, usual, build] of sectionsOf(report, data)) {
    const body = build(report, data);
    if (!body) continue;
    const title = id === "runs" && report.runs.length === 1 ? report.runs[0].title
      : id === "validity" && inTime(report) ? "Validity in time" : usual;
    main.append(el("section", { id, "aria-labelledby": id + "-title" },
      el("h2", { id: id + "-title" }, title), body));
    shown.push({ id, title });
  }
  if (notices) main.append(notices);  // beside the contents, which stay as long as main does
  data.mounts.forEach(mount => mount());  // a plot needs its box in the page, to know its width
  document.getElementById("contents").replaceChildren(contents(shown, report));
}

try {
  render();
  DARK.addEventListener("change", render);  // curves take their colours when they are drawn
  document.documentElement.dataset.ready = "true";
} catch (error) {
  document.body.prepend(el("p.error-box", { role: "alert" }, "This report could not be drawn: " + error.message
    + ". The numbers are in report.json and in the CSV files of the same directory."));
  document.documentElement.dataset.ready = "error";
  console.error(error);
}

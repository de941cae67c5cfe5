// The curves of a page as its sections and figures use them.

// What the sections need of the curves. A run backwards has falling angles: `order` lists the samples by
// rising angle. The axis is rounded out to whole turns where the last step of a turn is all that is missing.
function orderOf(theta, angle) {
  const order = theta.map((_, i) => i).sort((a, b) => theta[a] - theta[b]);
  const first = theta[order[0]], last = theta[order[order.length - 1]];
  const step = order.length > 1 ? (last - first) / (order.length - 1) : 360;
  const turns = (v, round) =>
    (angle && Math.abs(360 * round(v / 360) - v) <= 1.01 * step ? 360 * round(v / 360) : v);
  return { theta, order, step, low: turns(first, Math.floor), high: turns(last, Math.ceil) };
}

const SHAFT_ANGLE = "shaft angle (deg)";

function prepare(report, given) {
  const curves = unpacked(given);
  const tables = list(curves.tables).map(t => ({ name: t.name, columns: t.columns || {} }));
  const channels = new Map(list(report.channels).map(c => [c.name, c]));
  const about = name => channels.get(name) || {};
  const usual = ["analytic", "multibody"];
  const pair = [0, 1].map(i => (tables[i] || list(report.models)[i] || {}).name || usual[i]);
  return {
    ...orderOf(list(curves.theta_deg), !curves.axis), marks: list(curves.marks), samples: curves.samples,
    axis: { label: curves.axis || SHAFT_ANGLE, angle: !curves.axis }, cursor: cursorOf(curves.axis || SHAFT_ANGLE), tables, pair,
    difference: curves.difference || {}, reference: curves.reference || null, mounts: [],
    ofTable: (row, i) => row[pair[i]] ?? row[usual[i]] ?? null,
    meaning: name => phrases(about(name).meaning, about(name).on_body && "on " + about(name).on_body),
    pistonOf: name => String(about(name).piston || name),
  };
}

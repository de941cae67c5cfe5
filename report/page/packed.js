// Curves of the page's own block, which holds them packed (docs/report_json.md).

const KEPT = 5;  // bytes of a number, its upper ones

function unpackedColumn(base64) {
  const text = atob(base64), count = text.length / KEPT, view = new DataView(new ArrayBuffer(8 * count));
  for (let i = 0; i < text.length; i++) view.setUint8(8 * Math.floor(i / KEPT) + 8 - KEPT + i % KEPT, text.charCodeAt(i));
  return Array.from({ length: count }, (_, i) => {
    const value = view.getFloat64(8 * i, true);
    return Number.isNaN(value) ? null : value;  // not computed
  });
}

// Curves as figures have their own: every column a list of numbers. What is a list stays as it is.
function unpacked(curves) {
  const opened = columns => Object.fromEntries(Object.entries(columns || {}).map(
    ([name, column]) => [name, typeof column === "string" ? unpackedColumn(column) : column]));
  const difference = opened(curves.difference), tables = list(curves.tables).map(t => ({ ...t, columns: opened(t.columns) }));
  const following = name => tables[0].columns[name].map((v, i) => v == null ? null : v + ((difference[name] || [])[i] || 0));
  if (tables[1])
    for (const [name, column] of Object.entries(tables[1].columns))
      if (column === true) tables[1].columns[name] = following(name);
  return { ...curves, tables, difference };
}

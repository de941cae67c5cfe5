// Curves of the page's own block, which holds them packed (docs/report_json.md).

const NOT_COMPUTED = -0x80000000;

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return new DataView(bytes.buffer);
}

// Whole numbers of 10^-decimals; null where not computed.
function unpackedColumn([decimals, base64]) {
  const view = bytesOf(base64), values = new Array(view.byteLength >> 2);
  const scale = 10 ** Math.abs(decimals);
  for (let i = 0; i < values.length; i++) {
    const n = view.getInt32(4 * i, true);
    values[i] = n === NOT_COMPUTED ? null : decimals > 0 ? n / scale : n * scale;
  }
  return values;
}

// The first table's column with what the second one differs by, to as many decimals.
function following(first, [decimals], difference) {
  if (!difference) return first;
  const scale = 10 ** decimals;
  return first.map((v, i) => v == null || !difference[i] ? v : Math.round((v + difference[i]) * scale) / scale);
}

// Curves as figures have their own: every column a list of numbers. What is a list stays as it is.
function unpacked(curves) {
  const packed = column => Array.isArray(column) && typeof column[1] === "string";
  const opened = columns => Object.fromEntries(Object.entries(columns || {}).map(
    ([name, column]) => [name, packed(column) ? unpackedColumn(column) : column]));
  const difference = opened(curves.difference), tables = list(curves.tables).map(t => ({ ...t, columns: opened(t.columns) }));
  if (tables[1])
    for (const [name, column] of Object.entries(tables[1].columns))
      if (column === true)
        tables[1].columns[name] = following(tables[0].columns[name], curves.tables[0].columns[name], difference[name]);
  return { ...curves, tables, difference };
}

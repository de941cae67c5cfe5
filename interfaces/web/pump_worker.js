// Runs the models beside the page: messages {id, call, ..} in, {id, ..} out. Stands behind the module that Emscripten makes.

const WORK = "/case";  // the folder of the case and of the files that it names

function pumpCalls(module) {
  const text = (name, ...given) => module.ccall(name, "string", given.map(v => (typeof v === "number" ? "number" : "string")), given);
  const json = (name, ...given) => JSON.parse(text(name, ...given));
  const design = ({ file, text, changes }) => [WORK + "/" + file, text, changes];
  const numbers = (name, which, count) => {
    const at = module.ccall(name, "number", ["number"], [which]);
    return module.HEAPF64.slice(at / 8, at / 8 + count);
  };
  module.FS.mkdirTree(WORK);
  return {
    // A file that a case names, by its path there.
    file({ path, text }) {
      const place = WORK + "/" + path;
      module.FS.mkdirTree(place.slice(0, place.lastIndexOf("/")));
      module.FS.writeFile(place, text);
      return {};
    },
    compute({ which, ...given }) {
      const found = which < 0 ? json("bentaxis_compute", which, "", "", "") : json("bentaxis_compute", which, ...design(given));
      if (found.error || which < 0) return found;
      return { ...found, angles: numbers("bentaxis_angles", which, found.rows),
               values: numbers("bentaxis_values", which, found.rows * found.columns) };
    },
    channels: ({ which }) => ({ channels: json("bentaxis_channels", which) }),
    parameters(given) {
      const tables = json("bentaxis_parameters", ...design(given));
      return tables.error ? tables : { tables };
    },
    text: given => json("bentaxis_case_text", ...design(given)),
    document: () => json("bentaxis_document"),
  };
}

if (typeof importScripts === "function") {
  const ready = bentaxisModule().then(pumpCalls);
  const failed = error => ({ error: String(error && error.message || error),
                             kind: error instanceof RangeError || /memory|allocat/i.test(String(error)) ? "memory" : "died" });
  ready.then(() => postMessage({ id: "ready" }), error => postMessage({ id: "ready", ...failed(error) }));
  onmessage = async ({ data: { id, call, ...given } }) => {
    let found;
    try {
      found = (await ready)[call](given);
    } catch (error) {
      found = failed(error);
    }
    postMessage({ id, ...found }, [found.angles, found.values].filter(Boolean).map(a => a.buffer));
  };
} else if (typeof module === "object") {
  module.exports = { start: () => bentaxisModule().then(pumpCalls) };
}

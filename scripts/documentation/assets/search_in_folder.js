// A page opened from a folder may load scripts, but neither a worker nor a file of data. So the search's worker comes as
// text in this script and its index in another one, which is loaded behind the page.
var bentaxisSearchIndex;
var __search = {
  worker: URL.createObjectURL(new Blob(["WORKER"], { type: "text/javascript" })),
  index: new Promise((done, failed) => {
    bentaxisSearchIndex = done;
    const script = document.createElement("script");
    script.src = document.currentScript.src.replace("search_in_folder.js", "search_index.js");
    script.async = true;
    script.onerror = () => failed(new Error("the search index cannot be loaded"));
    document.head.append(script);
  }),
};

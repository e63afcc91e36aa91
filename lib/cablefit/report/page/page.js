// Draws the report from the JSON in the page. Texts come from logs and rig files: they only ever
// become text nodes, or go through plain() on their way to plotly.
"use strict";
(() => {
  const report = JSON.parse(document.getElementById("report").textContent);
  const darkWanted = matchMedia("(prefers-color-scheme: dark)");
  const plots = [];

  // --- pieces of the page -------------------------------------------------------------------------

  /** make("p", {class: "note"}, "text", node, ...) */
  function make(tag, attributes, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
    for (const child of children) node.append(child);  // strings become text nodes
    return node;
  }

  function headerCell(column) {
    const cell = make("th", {class: column.text ? "text" : "", scope: "col"}, column.title);
    if (column.unit) cell.append(make("small", {}, "[" + prettyUnit(column.unit) + "]"));
    return cell;
  }

  function groupRow(columns) {
    const row = make("tr");
    for (let k = 0; k < columns.length;) {
      let end = k + 1;
      while (end < columns.length && columns[k].group && columns[end].group === columns[k].group) ++end;
      const group = columns[k].group;
      row.append(make("th", {colspan: end - k, class: group ? "group" : ""}, group));
      k = end;
    }
    return row;
  }

  const printed = (cell) => prettyUnit(cell.replace(/\+- /g, "± ").replace(/ -> /g, " → "));
  const isLong = (text) => text.length > 60;

  function tableNode(table) {
    const head = make("thead");
    if (table.columns.some((column) => column.group)) head.append(groupRow(table.columns));
    head.append(make("tr", {}, ...table.columns.map(headerCell)));
    const body = make("tbody");
    for (const row of table.rows) {
      body.append(make("tr", {}, ...row.map((cell, k) => make("td", {
        class: (table.columns[k].text ? "text" : "") + (isLong(cell) ? " long" : "")
      }, printed(cell)))));
    }
    const node = make("div", {}, make("div", {class: "scroll"}, make("table", {}, head, body)));
    for (const note of table.notes) node.append(make("p", {class: "note"}, note));
    return node;
  }

  function titledTable(table) {
    const node = tableNode(table);
    if (table.title) node.prepend(make("h4", {}, table.title));
    return node;
  }

  function detailTable(table) {
    return make("details", {open: ""}, make("summary", {}, table.title || "Table"), tableNode(table));
  }

  function decisionTable(decisions) {
    return {
      title: "",
      columns: ["preload", "choice", "value", "reason"].map((title) => (
          {group: "", title, unit: "", text: true})),
      rows: decisions.map((line) => [line.where.join(", ") || "all", line.name, line.value, line.reason]),
      notes: []
    };
  }

  // --- figures ------------------------------------------------------------------------------------

  /** Little-endian floats of base64, relative to a base (page_data.hpp). */
  function numbers(packed) {
    const bytes = atob(packed.floats);
    const view = new DataView(new ArrayBuffer(bytes.length));
    for (let i = 0; i < bytes.length; ++i) view.setUint8(i, bytes.charCodeAt(i));
    const values = new Float64Array(bytes.length / 4);
    for (let i = 0; i < values.length; ++i) values[i] = packed.base + view.getFloat32(4 * i, true);
    return values;
  }

  /** Plotly reads some HTML in its texts; what comes from a log has none. */
  const plain = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");

  /** "rad^2" as it is printed; symbols as the paper writes them. */
  const powers = {0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹"};
  const prettyUnit = (text) => text.replace(/\^(\d+)/g, (_, n) => [...n].map((d) => powers[d]).join(""));
  const prettySymbols = (text) => text.replace(/theta/g, "θ").replace(/\btau(?![a-z])/g, "τ").replace(/ - /g, " − ");
  const withIndices = (html) => html.replace(/([A-Za-zθτ]\d*)_([A-Za-z0-9]+)/g, "$1<sub>$2</sub>");
  const axisTitle = (axis) => withIndices(plain(prettySymbols(axis.title))) +
      (axis.unit ? " [" + plain(prettyUnit(axis.unit)) + "]" : "");

  /** Colours of page.css, of the dark or the light scheme. */
  function palette(dark) {
    const root = document.documentElement;
    const was = root.classList.contains("dark");
    root.classList.toggle("dark", dark);
    const style = getComputedStyle(root);
    const colour = (name) => style.getPropertyValue("--" + name).trim();
    const colours = {
      ground: colour("ground"), ink: colour("ink"), grid: colour("grid"), rule: colour("rule"),
      faint: colour("faint"), again: colour("again"), below: colour("below"), reference: colour("reference"),
      series: [0, 1, 2, 3, 4, 5, 6].map((k) => colour("series-" + k))
    };
    root.classList.toggle("dark", was);
    return colours;
  }

  function drawnLook(trace, colour, fillColour, many, few) {
    switch (trace.style) {
      case "points":
        return {mode: "markers", marker: {color: colour, size: many ? 3 : 4, opacity: 0.65}};
      case "steps":
        return {mode: "lines", line: {color: colour, width: 1.5, shape: "hvh"}};
      case "dashed":
        return {mode: "lines", line: {color: colour, width: 1.5, dash: "dash"}};
      case "interval":
        return {mode: "markers", marker: {color: colour, size: 8}};
      case "area":
        return {mode: "lines", fill: "toself", fillcolor: fillColour, line: {color: colour, width: 1}};
      case "broad":
        return {mode: "lines", line: {color: colour, width: 4}};
      default:  // few points may have no neighbour to be joined with
        return {mode: few ? "lines+markers" : "lines", line: {color: colour, width: 1.4},
                marker: {color: colour, size: 6}};
    }
  }

  /** Milliseconds of an ISO date, with or without a time of day. */
  const time = (date) => Date.parse(date + (date.length > 10 ? "Z" : ""));
  const isoTime = (milliseconds) => new Date(milliseconds).toISOString().slice(0, 19);

  /** All dates, with some room beside the first and the last, which bars need. */
  function dateRange(figure) {
    const times = figure.traces.flatMap((trace) => trace.labels).map(time);
    const [from, to] = [Math.min(...times), Math.max(...times)];
    const room = 0.06 * (to - from);
    return [isoTime(from - room), isoTime(to + room)];
  }

  /** Names along the x axis, in the order in which they come; dates have places of their own. */
  const labelsOf = (figure) => figure.x.dates ? [] :
      [...new Set(figure.traces.flatMap((trace) => trace.labels || []))];

  function labelPlaces(figure, trace, k) {
    if (figure.x.dates) {  // a little beside each other, so that bars of one day can be told apart
      const [from, to] = dateRange(figure).map(time);
      const apart = 0.01 * (k - (figure.traces.length - 1) / 2) * (to - from);
      return trace.labels.map((date) => isoTime(time(date) + apart));
    }
    const labels = labelsOf(figure);
    const aside = (k - (figure.traces.length - 1) / 2) * 0.12;
    return trace.labels.map((label) => labels.indexOf(label) + aside);
  }

  function drawnTrace(figure, k, colours) {
    const trace = figure.traces[k];
    const before = figure.traces.slice(0, k).some(
        (other) => other.series === trace.series && other.style === trace.style);
    let colour = trace.series < 0 ? colours.reference : colours.series[trace.series % 7];
    if (before && trace.style === "points") colour = colours.again;
    if (trace.style === "broad") colour = colours.below;
    const y = numbers(trace.y);
    const drawn = {
      type: "scatter", name: withIndices(plain(prettySymbols(trace.name))), y, connectgaps: false,
      x: trace.labels ? labelPlaces(figure, trace, k) : numbers(trace.x),
      showlegend: trace.name !== "",
      customdata: trace.labels,
      hovertemplate: (figure.x.dates ? "%{customdata}<br>" : trace.labels ? "" : "%{x:.6g} " + plain(prettyUnit(figure.x.unit)) + "<br>") + "%{y:.5g} " +
          plain(prettyUnit(figure.y.unit)) + "<extra>%{fullData.name}</extra>",
      ...drawnLook(trace, colour, colours.grid, y.length > 400, y.length < 16)
    };
    if (trace.style === "interval") {
      const [low, high] = [numbers(trace.low), numbers(trace.high)];
      drawn.error_y = {type: "data", symmetric: false, array: high.map((v, i) => v - y[i]),
                       arrayminus: low.map((v, i) => y[i] - v), color: colour, thickness: 1.5, width: 5};
    }
    return drawn;
  }

  const shortened = (text) => text.length > 32 ? text.slice(0, 30) + "…" : text;

  function markAnnotations(figure, colours) {
    if (figure.marks.length > 8) return [];  // no room for the words
    return figure.marks.map((mark) => ({
      x: mark.x, y: 1, yref: "paper", xanchor: "left", yanchor: "bottom", showarrow: false,
      text: plain(shortened(mark.text)), font: {size: 10, color: colours.faint}
    }));
  }

  const noteAnnotations = (figure, colours) => figure.notes.map((note) => ({
    x: note.x, y: note.y, showarrow: false, text: plain(note.text), font: {size: 11.5, color: colours.ink},
    bgcolor: colours.ground, borderpad: 1
  }));

  function drawnAxis(axis, colours) {
    return {title: {text: axisTitle(axis), standoff: 8}, color: colours.ink, gridcolor: colours.grid,
            zerolinecolor: colours.rule, linecolor: colours.rule, showline: true, mirror: true,
            ticks: "outside", ticklen: 4, tickcolor: colours.rule, automargin: true,
            exponentformat: "power", separatethousands: false};
  }

  function drawnLayout(figure, colours) {
    const layout = {
      font: {family: "system-ui, 'Liberation Sans', Arial, sans-serif", size: 12, color: colours.ink},
      paper_bgcolor: colours.ground, plot_bgcolor: colours.ground, uirevision: "keep",
      margin: {l: 58, r: 14, t: 12, b: 46}, hovermode: "closest", dragmode: "zoom",
      hoverlabel: {font: {size: 12}},
      legend: {orientation: "h", x: 0, y: 1.02, yanchor: "bottom", xanchor: "left",
               itemsizing: "constant", font: {size: 11.5}},
      xaxis: drawnAxis(figure.x, colours), yaxis: drawnAxis(figure.y, colours),
      shapes: figure.marks.map((mark) => ({
        type: "line", x0: mark.x, x1: mark.x, y0: 0, y1: 1, yref: "paper", layer: "below",
        line: {color: colours.reference, width: 1, dash: "dot"}
      })),
      annotations: markAnnotations(figure, colours)
    };
    if (layout.annotations.length) layout.legend.y = 1.09;
    layout.annotations.push(...noteAnnotations(figure, colours));
    const labels = labelsOf(figure);
    if (labels.length) {
      Object.assign(layout.xaxis, {tickvals: labels.map((_, k) => k), ticktext: labels.map(plain),
                                   range: [-0.5, labels.length - 0.5], zeroline: false});
    }
    if (figure.x.dates) Object.assign(layout.xaxis, {type: "date", range: dateRange(figure)});
    return layout;
  }

  /** What plotly needs to draw a figure in light or dark, at a fixed width or that of its place. */
  function drawn(figure, dark, width) {
    const colours = palette(dark);
    const layout = drawnLayout(figure, colours);
    if (width) Object.assign(layout, {autosize: false, width, height: figure.wide ? 260 : 290});
    else Object.assign(layout, {autosize: true, width: undefined, height: undefined});
    return {data: figure.traces.map((_, k) => drawnTrace(figure, k, colours)), layout,
            config: {responsive: true, displayModeBar: false, doubleClick: "reset"}};
  }

  function draw(plot, dark, width) {
    const {data, layout, config} = drawn(plot.figure, dark, width);
    plot.isDrawn = true;
    return Plotly.react(plot.place, data, layout, config);
  }

  /** As it is zoomed and toggled now, but always on white: for papers. */
  async function saveSvg(plot) {
    if (!plot.isDrawn) await draw(plot, darkWanted.matches);
    const {data, layout} = drawn(plot.figure, false);
    data.forEach((trace, k) => { trace.visible = plot.place.data[k].visible; });
    for (const axis of ["xaxis", "yaxis"]) {
      const now = plot.place.layout[axis];
      if (now.range && now.autorange !== true) Object.assign(layout[axis], {range: [...now.range]});
    }
    const words = [plot.figure.section, plot.figure.group, plot.figure.title].join(" ");
    const filename = words.replace(/[^A-Za-z0-9]+/g, "_").replace(/^_+|_+$/g, "").slice(0, 100);
    return Plotly.downloadImage({data, layout},
                                {format: "svg", filename, width: plot.figure.wide ? 900 : 480, height: 320});
  }

  function resetZoom(plot) {
    const labels = labelsOf(plot.figure);
    const x = labels.length ? {"xaxis.range": [-0.5, labels.length - 0.5]}
        : plot.figure.x.dates ? {"xaxis.range": dateRange(plot.figure)} : {"xaxis.autorange": true};
    return Plotly.relayout(plot.place, {...x, "yaxis.autorange": true});
  }

  function figureNode(figure) {
    const place = make("div", {class: "plot", role: "img", "aria-label": figure.title});
    const save = make("button", {type: "button", title: "Save this plot as SVG"}, "SVG");
    const reset = make("button", {type: "button", title: "Show everything again"}, "Reset");
    const node = make("figure", {class: figure.wide ? "wide" : ""},
                      make("div", {class: "head"}, make("strong", {}, prettySymbols(figure.title)),
                           make("span", {class: "buttons"}, reset, save)), place);
    if (figure.caption) node.append(make("figcaption", {}, prettySymbols(figure.caption)));
    const plot = {figure, place, isDrawn: false};
    save.addEventListener("click", () => saveSvg(plot));
    reset.addEventListener("click", () => resetZoom(plot));
    plots.push(plot);
    return node;
  }

  // --- the page -----------------------------------------------------------------------------------

  function grouped(figures, key) {
    const groups = new Map();
    for (const figure of figures) {
      if (!groups.has(figure[key])) groups.set(figure[key], []);
      groups.get(figure[key]).push(figure);
    }
    return groups;
  }

  const contents = make("ul");
  let nChapters = 0;
  function chapter(title, tag, list) {
    const heading = make(tag, {id: "chapter-" + (++nChapters)}, title);
    const entry = make("li", {}, make("a", {href: "#" + heading.id}, title));
    list.append(entry);
    return {heading, entry};
  }

  function addFigures(main) {
    for (const [section, ofSection] of grouped(report.figures, "section")) {
      const {heading, entry} = chapter(section || "Plots", "h2", contents);
      main.append(heading);
      const sublist = make("ul");
      entry.append(sublist);
      for (const [group, figures] of grouped(ofSection, "group")) {
        if (group) main.append(chapter(group, "h3", sublist).heading);
        main.append(make("div", {class: "figures"}, ...figures.map(figureNode)));
      }
    }
  }

  function summaryNode() {
    return make("dl", {class: "summary"}, ...report.summary.flatMap((line) => [
      make("dt", {}, line.label), make("dd", {}, printed(line.text))]));
  }

  function addTables(main) {
    const tables = report.tables.filter((table) => !table.detail);
    if (!tables.length && !report.paragraphs.length) return;
    main.append(chapter("Results", "h2", contents).heading, ...tables.map(titledTable),
                make("ul", {}, ...report.paragraphs.map((text) => make("li", {}, text))));
  }

  function addRest(main) {
    if (report.decisions.length) {
      main.append(chapter("Choices", "h2", contents).heading, tableNode(decisionTable(report.decisions)));
    }
    const details = report.tables.filter((table) => table.detail && table.rows.length);
    if (details.length) main.append(chapter("Details", "h2", contents).heading, ...details.map(detailTable));
  }

  function warningsNode() {
    return make("section", {class: "warnings"}, make("h2", {}, "Warnings"),
                make("ul", {}, ...report.warnings.map((text) => make("li", {}, text))));
  }

  function build() {
    const title = report.title || "What is in the logs";
    document.title = title + " - cablefit";
    const main = make("main");
    if (report.warnings.length) main.append(warningsNode());
    if (report.summary.length) main.append(chapter("In short", "h2", contents).heading, summaryNode());
    addTables(main);
    addFigures(main);
    addRest(main);
    document.body.append(make("div", {class: "frame"},
        make("header", {}, make("h1", {}, title),
             make("p", {}, "Drag to zoom, double-click to go back; click a name in a legend to hide it, " +
                           "double-click to see it alone. Curves and clouds are thinned for drawing " +
                           "so that no peak is lost; fits use every row.")),
        make("div", {class: "columns"}, make("nav", {"aria-label": "Contents"}, contents), main),
        make("footer", {}, "cablefit " + report.version + ". Plots by plotly.js (MIT licence).")));
  }

  /** Plots are drawn when they come near the screen, which keeps long pages quick to open. */
  function drawWhenSeen() {
    const observer = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        const plot = plots.find((one) => one.place === entry.target);
        if (entry.isIntersecting && !plot.isDrawn) draw(plot, darkWanted.matches);
      }
    }, {rootMargin: "800px"});
    for (const plot of plots) observer.observe(plot.place);
  }

  const kPaperWidth = 670;  // px, A4 within its margins

  function forPaper() {
    document.documentElement.classList.remove("dark");
    for (const detail of document.querySelectorAll("details")) detail.open = true;
    for (const plot of plots) draw(plot, false, plot.figure.wide ? kPaperWidth : kPaperWidth * 0.48);
  }

  function forScreen() {
    document.documentElement.classList.toggle("dark", darkWanted.matches);
    for (const plot of plots) if (plot.isDrawn) draw(plot, darkWanted.matches);
  }

  document.documentElement.classList.toggle("dark", darkWanted.matches);
  build();
  drawWhenSeen();
  darkWanted.addEventListener("change", forScreen);
  addEventListener("beforeprint", forPaper);
  addEventListener("afterprint", forScreen);

  // For scripts that want every plot on the page, scrolled to or not.
  globalThis.cablefitReport = {
    plots, saveSvg,
    drawAll: () => Promise.all(plots.map((plot) => draw(plot, darkWanted.matches)))
  };
})();

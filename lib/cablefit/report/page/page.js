// Draws the plots of the report, from the JSON in the page into the places that stand there. Texts
// come from logs and rig files: they go through plain() on their way to plotly.
"use strict";
(() => {
  const report = JSON.parse(document.getElementById("report").textContent);
  const darkWanted = matchMedia("(prefers-color-scheme: dark)");
  const plots = [];

  /** make("p", {class: "note"}, "text", node, ...) */
  function make(tag, attributes, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
    for (const child of children) node.append(child);  // strings become text nodes
    return node;
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

  const withIndices = (html) => html.replace(/([A-Za-zθτ]\d*)_([A-Za-z0-9]+)/g, "$1<sub>$2</sub>");
  const axisTitle = (axis) => withIndices(plain(axis.title)) + (axis.unit ? " [" + plain(axis.unit) + "]" : "");

  /** Colours of page.css, of the dark or the light scheme. */
  function palette(dark) {
    const root = document.documentElement;
    const was = root.classList.contains("dark");
    root.classList.toggle("dark", dark);
    const style = getComputedStyle(root);
    const names = ["ground", "ink", "grid", "rule", "faint", "again", "below", "reference",
                   ...[0, 1, 2, 3, 4, 5, 6].map((k) => "series-" + k)];
    const colours = Object.fromEntries(
        names.map((name) => [name, style.getPropertyValue("--" + name).trim()]));
    root.classList.toggle("dark", was);
    return colours;
  }

  /** Symbols of a line: every point has one, or some that are evenly spread. */
  function lineWithSymbols(look, line, colour, n) {
    if (look.symbols === 0) return {mode: "lines", line};
    const few = look.symbols < n ? {maxdisplayed: look.symbols} : {};
    return {mode: "lines+markers", line, marker: {color: colour, size: 7, symbol: look.symbol, ...few}};
  }

  function drawnLook(trace, colour, fillColour, n) {
    const look = trace.look;
    const line = {color: colour, width: look.width, dash: look.dash || "solid"};
    switch (trace.style) {
      case "points":
        return {mode: "markers", marker: {color: colour, size: n > 400 ? 3 : 4, opacity: 0.65, symbol: look.symbol}};
      case "steps":
        return {mode: "lines", line: {...line, shape: "hvh"}};
      case "interval":
        return {mode: "markers", marker: {color: colour, size: 8, symbol: look.symbol}};
      case "area":
        return {mode: "lines", fill: "toself", fillcolor: fillColour, line};
      default:
        return lineWithSymbols(look, line, colour, n);
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
    const colour = colours[trace.look.colour];
    const y = numbers(trace.y);
    const drawn = {
      type: "scatter", name: withIndices(plain(trace.name)), y, connectgaps: false,
      x: trace.labels ? labelPlaces(figure, trace, k) : numbers(trace.x),
      showlegend: trace.name !== "",
      customdata: trace.labels,
      hovertemplate: (figure.x.dates ? "%{customdata}<br>" : trace.labels ? "" : "%{x:.6g} " + plain(figure.x.unit) + "<br>") + "%{y:.5g} " +
          plain(figure.y.unit) + "<extra>%{fullData.name}</extra>",
      ...drawnLook(trace, colour, colours.grid, y.length)
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
    x: note.x, y: figure.y.log ? Math.log10(note.y) : note.y, showarrow: false, text: plain(note.text), font: {size: 11.5, color: colours.ink},
    bgcolor: colours.ground, borderpad: 1
  }));

  function drawnAxis(axis, colours) {
    return {title: {text: axisTitle(axis), standoff: 8}, color: colours.ink, gridcolor: colours.grid,
            zerolinecolor: colours.rule, linecolor: colours.rule, showline: true, mirror: true,
            ticks: "outside", ticklen: 4, tickcolor: colours.rule, automargin: true,
            exponentformat: "power", separatethousands: false,
            ...(axis.log ? {type: "log", dtick: "D2", minexponent: 4} : {})};
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
    if (!plot.isDrawn) plot.place.replaceChildren();  // what stood there until now
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

  /** A plot and its buttons in the place that the page has for it. */
  function prepare(node) {
    const place = node.querySelector(".plot");
    const plot = {figure: report.figures[Number(node.dataset.figure)], place, isDrawn: false};
    const save = make("button", {type: "button", title: "Save this plot as SVG"}, "SVG");
    const reset = make("button", {type: "button", title: "Show everything again"}, "Reset");
    save.addEventListener("click", () => saveSvg(plot));
    reset.addEventListener("click", () => resetZoom(plot));
    node.querySelector(".head").append(make("span", {class: "buttons"}, reset, save));
    return plot;
  }

  // --- the page -----------------------------------------------------------------------------------

  /** A link of the contents leads to something folded: it opens. */
  function openTarget() {
    const target = document.getElementById(location.hash.slice(1));
    for (let node = target; node; node = node.parentElement) if (node.matches("details")) node.open = true;
  }

  /** Plots are drawn first when they come near the screen, which keeps long pages quick to open. */
  function drawWhenSeen() {
    const observer = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        const plot = plots.find((one) => one.place === entry.target);
        if (entry.isIntersecting && !plot.isDrawn) draw(plot, darkWanted.matches);
      }
    }, {rootMargin: "800px"});
    for (const plot of plots) observer.observe(plot.place);
  }

  const kIdleWait = 2000;  // ms, after which a plot is drawn although the browser is busy
  const whenIdle = globalThis.requestIdleCallback
      ? (work) => requestIdleCallback(work, {timeout: kIdleWait}) : (work) => setTimeout(work, 50);
  const isFolded = (plot) => plot.place.closest("details:not([open])") !== null;

  /** The other plots follow one by one, so that scrolling, a screenshot or print finds none empty. */
  function drawRest() {
    const next = plots.find((plot) => !plot.isDrawn && !isFolded(plot));
    if (!next) return;
    whenIdle(async () => {
      if (!next.isDrawn) await draw(next, darkWanted.matches);
      drawRest();
    });
  }

  const isWide = (plot) => plot.place.parentElement.classList.contains("wide");
  const kPaperWidth = 670;  // px, A4 within its margins

  function forPaper() {
    document.documentElement.classList.remove("dark");
    for (const plot of plots) {
      if (isFolded(plot)) continue;  // what is folded is not printed
      draw(plot, false, isWide(plot) ? kPaperWidth : kPaperWidth * 0.48);
    }
  }

  function forScreen() {
    document.documentElement.classList.toggle("dark", darkWanted.matches);
    for (const plot of plots) if (plot.isDrawn) draw(plot, darkWanted.matches);
  }

  document.documentElement.classList.toggle("dark", darkWanted.matches);
  plots.push(...[...document.querySelectorAll("figure[data-figure]")].map(prepare));
  drawWhenSeen();
  drawRest();
  openTarget();
  addEventListener("hashchange", openTarget);
  darkWanted.addEventListener("change", forScreen);
  addEventListener("beforeprint", forPaper);
  addEventListener("afterprint", forScreen);

  // For scripts that want every plot on the page, scrolled to or not.
  globalThis.cablefitReport = {
    plots, saveSvg,
    drawAll: () => Promise.all(plots.map((plot) => draw(plot, darkWanted.matches)))
  };
})();

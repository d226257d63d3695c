// Four plots over the last 20 s, by the charting library that the page brings along (ECharts).

import { colour, onTheme } from "./theme.js";

const SPAN_S = 20;
const SAMPLE_S = 0.05;
const REFRESH_MS = 125;
const ROOM = { left: 46, right: 12, height: 84, top: 26, pitch: 124 };

const PLOTS = [
  { title: "l  [m]", series: [["l", "ink"]], limits: ["l_min", "l_max"], pad: 0.1 },
  { title: "ψ  [rad]", series: [["psi", "ink"]], limits: ["psi_min", "psi_max"], pad: 0.2 },
  { title: "linear  [m/s]", series: [["v_b", "base"], ["v_m", "arm"]], span: 0.5 },
  { title: "angular  [rad/s]", series: [["w_b", "base"], ["w_m", "arm"]], span: 0.5 },
];
const FIELDS = PLOTS.flatMap((plot) => plot.series.map(([field]) => field));
const SYMBOLS = { l: "l", psi: "ψ", v_b: "v_b base", v_m: "v_m arm", w_b: "w_b base", w_m: "w_m arm" };

export class Plots {
  constructor(element) {
    this.element = element;
    this.data = Object.fromEntries(FIELDS.map((field) => [field, []]));
    this.last = -Infinity;
    onTheme(() => (this.fresh = false));
    setInterval(() => this.refresh(), REFRESH_MS);
  }

  add(state) {
    if (state.t < this.last) this.clear();
    if (state.t - this.last < SAMPLE_S) return;
    this.last = state.t;
    for (const field of FIELDS) {
      const points = this.data[field];
      points.push([state.t, state[field]]);
      while (points[0][0] < state.t - SPAN_S - 1) points.shift();
    }
    this.changed = true;
  }

  clear() {
    for (const field of FIELDS) this.data[field] = [];
    this.last = -Infinity;
  }

  configure(settings) {
    this.settings = settings;
    this.fresh = false;
  }

  // The page's library makes the chart on our element; until it has, there is none.
  get chart() {
    if (!this.library) {
      this.library = "asked";
      import("nicegui-echart").then((module) => (this.library = module.echarts));
    }
    return this.library === "asked" ? undefined : this.library.getInstanceByDom(this.element);
  }

  refresh() {
    const chart = this.chart;
    if (!chart || !this.settings || !this.element.offsetParent) return;
    if (!this.fresh) {
      chart.setOption(this.frame(), { notMerge: true });
      this.fresh = true;
      this.changed = true;
    }
    if (!this.changed) return;
    this.changed = false;
    const end = Number.isFinite(this.last) ? this.last : 0;
    chart.setOption({
      xAxis: PLOTS.map(() => ({ min: end - SPAN_S, max: end })),
      yAxis: PLOTS.map((plot) => this.range(plot)),
      series: FIELDS.map((field) => ({ data: this.data[field] })),
    });
  }

  range(plot) {
    const values = plot.series.flatMap(([field]) => this.data[field].map((point) => point[1]));
    const wanted = plot.limits ? plot.limits.map((limit) => this.settings[limit]) : [-plot.span, plot.span];
    const pad = plot.pad ?? 0;
    let [min, max] = [Math.min(...wanted) - pad, Math.max(...wanted) + pad];
    if (values.length) [min, max] = [Math.min(min, ...values), Math.max(max, ...values)];
    const step = max - min > 3 ? 1 : max - min > 0.9 ? 0.5 : 0.2;
    return { min: Math.floor(min / step + 1e-9) * step, max: Math.ceil(max / step - 1e-9) * step, interval: step };
  }

  frame() {
    const [ink, muted, line] = ["ink", "muted", "line"].map(colour);
    const text = { color: muted, fontSize: 11, fontFamily: "system-ui, sans-serif" };
    return {
      animation: false,
      title: PLOTS.map((plot, k) => ({
        text: plot.title, left: 0, top: k * ROOM.pitch + 4, textStyle: { color: ink, fontSize: 12, fontWeight: 600, fontFamily: "system-ui, sans-serif" },
      })),
      legend: PLOTS.flatMap((plot, k) => plot.series.length < 2 ? [] : [{
        data: plot.series.map(([field]) => SYMBOLS[field]), right: 8, top: k * ROOM.pitch + 1,
        textStyle: text, itemWidth: 14, itemHeight: 2, icon: "rect", selectedMode: false,
      }]),
      grid: PLOTS.map((_, k) => ({ left: ROOM.left, right: ROOM.right, top: k * ROOM.pitch + ROOM.top, height: ROOM.height })),
      xAxis: PLOTS.map((_, k) => ({
        gridIndex: k, type: "value", axisLine: { lineStyle: { color: line } }, splitLine: { show: false }, axisTick: { show: false },
        axisLabel: { show: false }, axisPointer: { show: false },
      })),
      yAxis: PLOTS.map((plot, k) => ({
        gridIndex: k, type: "value", ...this.range(plot), splitLine: { lineStyle: { color: line, opacity: 0.6 } },
        axisLabel: { ...text, formatter: (value) => (+value.toFixed(2)).toString() },
      })),
      series: PLOTS.flatMap((plot, k) => plot.series.map(([field, ink2], n) => ({
        name: SYMBOLS[field], type: "line", xAxisIndex: k, yAxisIndex: k, showSymbol: false, silent: true, data: this.data[field],
        lineStyle: { width: 1.8, color: colour(ink2) }, itemStyle: { color: colour(ink2) },
        markLine: n > 0 || !plot.limits ? undefined : {
          silent: true, symbol: "none", lineStyle: { color: colour("base"), type: "dashed", width: 1.2, opacity: 0.9 }, label: { show: false },
          data: plot.limits.map((limit) => ({ yAxis: this.settings[limit] })),
        },
      }))),
    };
  }
}

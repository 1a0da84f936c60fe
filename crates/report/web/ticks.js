// Ticks of logarithmic axes: as many as there is room for, none upon another.

/** Values at which an axis from 10^low to 10^high has ticks, so that neighbours are at least `room` of its length apart. */
function logTicks(low, high, room) {
  const apart = (values) => values.every((value, k) => k === 0 || Math.log10(value / values[k - 1]) >= room * (high - low));
  const inside = (value) => value >= 10 ** low * (1 - 1e-9) && value <= 10 ** high * (1 + 1e-9);
  const decades = Array.from({ length: Math.max(0, Math.floor(high) - Math.floor(low) + 1) }, (_, k) => Math.floor(low) + k);
  if (high - low > 0.8) {
    for (const digits of [[1, 2, 3, 4, 5, 6, 7, 8, 9], [1, 2, 5], [1, 3], [1]]) {
      const values = decades.flatMap((exponent) => digits.map((digit) => digit * 10 ** exponent)).filter(inside);
      if (apart(values)) return values;
    }
    for (let step = 2; ; step++) {
      const values = decades.filter((exponent) => exponent % step === 0).map((exponent) => 10 ** exponent).filter(inside);
      if (apart(values)) return values;
    }
  }
  // Less than a decade: even steps in the value.
  const [first, last] = [10 ** low, 10 ** high];
  for (let exponent = Math.floor(Math.log10((last - first) / 50)); ; exponent++) {
    for (const digit of [1, 2, 5]) {
      const step = digit * 10 ** exponent;
      const values = [];
      for (let k = Math.ceil(first / step); k * step <= last; k++) values.push(Number((k * step).toPrecision(12)));
      if (values.length < 30 && apart(values)) return values;
    }
  }
}

/** Puts ticks on the logarithmic axes of a plot that was drawn; true where they were others before. */
function setLogTicks(plot) {
  const full = plot.canvas._fullLayout;
  const change = {};
  for (const name of Object.keys(full).filter((name) => /^[xy]axis\d*$/.test(name))) {
    const axis = full[name];
    if (axis.type !== "log") continue;
    const [low, high] = axis.range;
    const room = (name[0] === "x" ? 64 : 22) / Math.max(60, axis._length);
    const values = logTicks(Math.min(low, high), Math.max(low, high), room);
    if (JSON.stringify(values) === JSON.stringify(axis.tickvals)) continue;
    const unit = axis.ticksuffix ?? "";
    change[`${name}.tickvals`] = values;
    change[`${name}.ticktext`] = values.map((value) => (unit ? inUnit(value, 4, unit).replace(" ", "") : digits(value, 4).replace(/^1·10/, "10")));
    if (unit) change[`${name}.ticksuffix`] = unit;
  }
  if (!Object.keys(change).length) return false;
  Plotly.relayout(plot.canvas, change);
  return true;
}

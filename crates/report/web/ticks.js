// Ticks of axes, with numbers as 2·10⁶: as many as there is room for, none upon another.

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
  return evenTicks(10 ** low, 10 ** high, apart);
}

/** Values in even steps from `first` to `last`, the most of which that `fits` says yes. */
function evenTicks(first, last, fits) {
  for (let exponent = Math.floor(Math.log10((last - first) / 50)); ; exponent++) {
    for (const digit of [1, 2, 5]) {
      const step = digit * 10 ** exponent;
      const values = [];
      for (let k = Math.ceil(first / step - 1e-9); k * step <= last + 1e-9 * step; k++) values.push(Number((k * step).toPrecision(12)));
      if (values.length < 30 && fits(values)) return values;
    }
  }
}

/** Values at which a linear axis has ticks, so that neighbours are at least `room` of its length apart. */
function linearTicks(low, high, room) {
  if (!(high > low)) return [];
  return evenTicks(low, high, (values) => values.length < 2 || values[1] - values[0] >= room * (high - low));
}

/** A tick in as few digits as tell it from its neighbours. */
function tickTexts(values) {
  for (let count = 1; ; count++) {
    const texts = values.map((value) => digits(value, count));
    if (count > 11 || values.every((value) => Math.abs(Number(value.toPrecision(count)) - value) <= 1e-9 * Math.abs(value))) return texts;
  }
}

/** Puts ticks on the axes of a plot that was drawn; true where they were others before. */
function setTicks(plot) {
  const full = plot.canvas._fullLayout;
  const given = plot.layout();
  const change = {};
  for (const name of Object.keys(given).filter((name) => /^[xy]axis\d*$/.test(name))) {
    const axis = full[name];
    // Labels and degrees are given.
    if (!axis || given[name].tickvals || given[name].dtick) continue;
    const [low, high] = [Math.min(...axis.range), Math.max(...axis.range)];
    const room = (name[0] === "x" ? 72 : axis.type === "log" ? 22 : 34) / Math.max(60, axis._length);
    const values = (axis.type === "log" ? logTicks : linearTicks)(low, high, room);
    if (axis.tickmode === "array" && JSON.stringify(values) === JSON.stringify(axis.tickvals)) continue;
    change[`${name}.tickmode`] = "array";
    change[`${name}.tickvals`] = values;
    change[`${name}.ticktext`] = axis.type === "log" ? values.map((value) => digits(value, 4).replace(/^1·10/, "10")) : tickTexts(values);
  }
  if (!Object.keys(change).length) return false;
  Plotly.relayout(plot.canvas, change);
  return true;
}

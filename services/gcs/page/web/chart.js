// The numbers of a chart under the pointer: read off its curves, by what its frame says of the axes.

const gcs = document.getElementById('gcs');
const rule = Object.assign(document.createElement('div'), { id: 'gcs-rule', hidden: true });
const readout = Object.assign(document.createElement('div'), { id: 'gcs-readout', hidden: true });
gcs.append(rule, readout);
const NEAR = 8;  // px of the drawing between the pointer and a point that it still means
let pointer = null;

const between = (from, to, share) => from + (to - from) * share;
const line = (tag, text) => Object.assign(document.createElement(tag), { textContent: text });

// Height [px of the drawing] of a curve at its point nearest to x; NaN where it has none.
function heightAt(curve, x) {
  let best = NEAR, height = NaN;
  for (const [, px, py] of curve.getAttribute('d').matchAll(/[ML]([-.\d]+) ([-.\d]+)/g)) {
    if (Math.abs(px - x) < best) [best, height] = [Math.abs(px - x), Number(py)];
  }
  return height;
}

function read() {
  const chart = pointer && document.elementFromPoint(...pointer)?.closest?.('#gcs .g-chart');
  rule.hidden = readout.hidden = true;
  if (!chart) return;
  const box = chart.getBoundingClientRect(), [left, right, top, bottom, low, high] = chart.dataset.frame.split(' ').map(Number);
  const x = (pointer[0] - box.left) / box.width * chart.viewBox.baseVal.width;
  if (x < left || x > right) return;
  const over = between(Number(chart.dataset.begin), Number(chart.dataset.end), (x - left) / (right - left));
  const digits = Math.min(Math.max(2 - Math.floor(Math.log10(high - low)), 0), 9);
  const rows = [line('b', `${over.toFixed(1)} ${chart.dataset.over}`)];
  for (const curve of chart.querySelectorAll('.g-curve')) {
    const y = heightAt(curve, x), value = between(high, low, (y - top) / (bottom - top));
    rows.push(line('span', `${curve.dataset.name} ${Number.isNaN(y) ? '–' : `${value.toFixed(digits)} ${chart.dataset.unit}`}`));
  }
  readout.replaceChildren(...rows);
  rule.hidden = readout.hidden = false;
  rule.style.cssText = `left: ${pointer[0]}px; top: ${box.top}px; height: ${box.height}px`;
  readout.style.left = `${Math.max(4, Math.min(pointer[0] - readout.offsetWidth - 12, innerWidth - readout.offsetWidth - 4))}px`;
  readout.style.top = `${Math.min(pointer[1] + 12, innerHeight - readout.offsetHeight - 4)}px`;
}

document.addEventListener('pointermove', event => {
  const within = !!event.target.closest?.('#gcs .g-chart');
  if (!within && !pointer) return;
  pointer = within ? [event.clientX, event.clientY] : null;
  read();
});
const away = () => { pointer = null; read(); };
document.addEventListener('pointercancel', away);
document.documentElement.addEventListener('pointerleave', away);
setInterval(() => { if (pointer) read(); }, 250);  // the curve goes on below a pointer that rests

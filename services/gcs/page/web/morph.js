// Brings live elements to what new markup says, changing only what differs: focus, scrolling and half-written input survive.

const keyOf = node => node.nodeType === 1 ? node.id || node.dataset.key || '' : '';
const fits = (old, fresh) => old.nodeType === fresh.nodeType && old.nodeName === fresh.nodeName && keyOf(old) === keyOf(fresh);

export function morph(target, source) {
  const keyed = new Map();
  for (const child of target.children) if (keyOf(child)) keyed.set(keyOf(child), child);
  let old = target.firstChild;
  for (const fresh of [...source.childNodes]) {
    const match = keyOf(fresh) ? keyed.get(keyOf(fresh)) : old;
    if (match && match.parentNode === target && fits(match, fresh)) {
      if (match === old) old = old.nextSibling;
      else target.insertBefore(match, old);
      patch(match, fresh);
    } else target.insertBefore(fresh, old);
  }
  while (old) { const next = old.nextSibling; old.remove(); old = next; }
}

function patch(old, fresh) {
  if (old.nodeType !== 1) { if (old.nodeValue !== fresh.nodeValue) old.nodeValue = fresh.nodeValue; return; }
  if (old.isEqualNode(fresh)) return;
  const written = old.getAttribute('value') !== fresh.getAttribute('value');
  const ticked = old.hasAttribute('checked') !== fresh.hasAttribute('checked');
  for (const { name } of [...old.attributes]) if (!fresh.hasAttribute(name) && !isOwn(old, name)) old.removeAttribute(name);
  for (const { name, value } of fresh.attributes) if (old.getAttribute(name) !== value && !isOwn(old, name)) old.setAttribute(name, value);
  if (old.nodeName === 'INPUT') {
    if (ticked) old.checked = fresh.hasAttribute('checked');
    if (written && !old.dataset.held && (old !== document.activeElement || old.type === 'range')) old.value = fresh.getAttribute('value') || '';
  }
  if (old.nodeName === 'SELECT' && old === document.activeElement) return;
  morph(old, fresh);
}

// What the reader has opened stays open, whatever the server drew.
// What is being moved stays under the pointer.
const isOwn = (element, name) => (element.nodeName === 'DETAILS' && name === 'open') || (element.dataset.held && /^(data-[xyz]|data-held|style|value)$/.test(name))
  || (name === 'style' && element.classList.contains('g-handle'));

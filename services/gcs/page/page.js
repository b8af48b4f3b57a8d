((bridge, css) => {
  const LOST = '<b>■ LINK LOST: the ground station has fallen silent, this picture is old</b>';
  let style = document.getElementById('gcs-style');
  if (!style) { style = document.createElement('style'); style.id = 'gcs-style'; document.head.append(style); }
  style.textContent = css;
  document.title = 'UVF ground station';
  document.hasFocus = () => true;
  window.__gcsBridge = bridge;
  window.__gcsJoined = performance.now();
  if (window.__gcs) return;
  window.__gcs = true;
  // The vehicle shown here. After a lost connection it is asked for until it is back, or another one has been chosen meanwhile.
  let wanted = '', bridged = bridge, restoring = false, first = '', asked = 0;
  const send = text => { const m = window.__viserMutable; if (m) m.sendMessage({type: 'GuiUpdateMessage', uuid: window.__gcsBridge, updates: {value: text}}); };
  document.body.dataset.log = 'notice';
  document.addEventListener('click', e => { const filter = e.target.closest && e.target.closest('[data-log]'); if (filter && filter !== document.body) document.body.dataset.log = filter.dataset.log; });
  const say = text => send(JSON.stringify([text, Date.now()]));
  const press = e => {
    const card = e.target.closest && e.target.closest('[data-gcs]');
    if (!card) return;
    if (card.dataset.gcs.startsWith('select:')) { wanted = card.dataset.gcs.slice(7); restoring = false; }
    say(card.dataset.gcs);
  };
  document.addEventListener('pointerdown', press);
  document.addEventListener('keydown', e => { if (e.key === 'Enter' || e.key === ' ') press(e); });
  const hand = e => { const page = window.__viserMutable; if (page && e.target === page.canvas && (e.type === 'wheel' || e.buttons)) window.__gcsHand = true; };
  for (const type of ['wheel', 'pointermove']) document.addEventListener(type, hand, {capture: true, passive: true});
  const bar = document.createElement('div');
  bar.id = 'gcs-bar'; bar.setAttribute('role', 'status'); document.body.append(bar);
  let shape = '', told = 0, looked = 0;
  let beat = '', silent = 0, ticked = performance.now();
  setInterval(() => {
    const canvas = window.__viserMutable && window.__viserMutable.canvas;
    if (canvas) {
      const box = canvas.getBoundingClientRect(), root = document.documentElement.style;
      root.setProperty('--gcs-left', box.left + 'px'); root.setProperty('--gcs-width', box.width + 'px');
      const seen = (box.width / Math.max(box.height, 1)).toFixed(3), time = performance.now();
      if (seen !== shape || time - told > 2000) { shape = seen; told = time; say((window.__gcsHand ? 'hand:' : 'shape:') + shape); }
    }
    const cameras = document.getElementById('gcs-cameras'), seen = cameras && !document.hidden && cameras.getClientRects().length > 0;
    if (seen && performance.now() - looked > 1000) { looked = performance.now(); say('looks'); }
    const source = document.getElementById('gcs-bar-source');
    const now = performance.now(), shown = source && source.querySelector('.g-follow');
    if (bridged !== window.__gcsBridge) { bridged = window.__gcsBridge; restoring = wanted !== ''; first = ''; }
    if (shown && source.dataset.bridge === bridged) {  // else it is what the connection before has left
      const name = shown.dataset.name;
      first = first || name;
      if (name === wanted || name !== first || now - window.__gcsJoined > 60000) restoring = false;
      if (!restoring) wanted = name;
      else if (now - asked > 500) { asked = now; say('select:' + wanted); }
    }
    silent += Math.min(now - ticked, 400);  // a page that stood still itself has yet to read what came meanwhile
    ticked = now;
    if (source && source.dataset.beat !== beat) { beat = source.dataset.beat; silent = 0; if (bar.innerHTML !== source.innerHTML) bar.innerHTML = source.innerHTML; }
    const dead = silent > 3000;
    bar.classList.toggle('g-dead', dead);
    if (dead) bar.innerHTML = LOST;
  }, 200);
  const wheel = () => document.querySelector('#gcs-wheel[data-driver="mine"]');
  const held = new Map();  // the key or pointer that holds it -> [forward, left]
  let drove = false;
  const steer = () => {
    if (!wheel()) held.clear();
    if (!held.size && !drove) return;
    const way = [0, 1].map(i => Math.max(-1, Math.min(1, [...held.values()].reduce((sum, one) => sum + Number(one[i]), 0))));
    drove = held.size > 0;
    say(`steer:${way.join(':')}`);
  };
  setInterval(steer, 100);
  const hold = (by, button) => { held.set(by, button.dataset.steer.split(' ')); steer(); };
  const release = by => { const was = held.delete(by); if (was) steer(); return was; };
  const releaseAll = () => { if (held.size) { held.clear(); steer(); } };
  const typing = e => e.target.closest && e.target.closest('input,textarea,[contenteditable]');
  window.addEventListener('keydown', e => {
    const panel = wheel();
    if (!panel || e.ctrlKey || e.altKey || e.metaKey || typing(e)) return;
    const button = panel.querySelector(`[data-keys~="${CSS.escape(e.key.length === 1 ? e.key.toLowerCase() : e.key)}"]`);
    if (!button) return;
    e.preventDefault(); e.stopImmediatePropagation();
    if (!button.dataset.steer) say(button.dataset.gcs);
    else if (!held.has(e.code)) hold(e.code, button);  // a held key is repeated: it drives on after the panel or the window was away
  }, true);
  window.addEventListener('keyup', e => { if (release(e.code)) e.stopImmediatePropagation(); }, true);
  window.addEventListener('pointerdown', e => {
    const button = wheel() && e.button === 0 && e.target.closest && e.target.closest('#gcs-wheel [data-steer]');
    if (button) { e.preventDefault(); hold('pointer' + e.pointerId, button); }
  }, true);
  for (const type of ['pointerup', 'pointercancel']) window.addEventListener(type, e => release('pointer' + e.pointerId), true);
  for (const type of ['blur', 'pagehide']) window.addEventListener(type, releaseAll);
  document.addEventListener('visibilitychange', () => { if (document.hidden) releaseAll(); });
  let last = null;
  const follow = () => {
    requestAnimationFrame(follow);
    const page = window.__viserMutable, chosen = document.querySelector('#gcs-bar-source .g-follow');
    const control = page && page.cameraControl, node = page && chosen && page.nodeRefFromName['/vehicles/' + chosen.dataset.name];
    if (!window.__gcsFollow || !control || !node) { last = null; return; }
    const at = node.getWorldPosition(node.position.clone());
    const eye = control.getPosition(at.clone()), target = control.getTarget(at.clone());
    const turned = window.__gcsHand && last && last.name === chosen.dataset.name;  // else the distance holds, whatever moved the view
    const move = at.clone().sub(turned ? last.at : target);
    if (!turned) eye.sub(target).setLength(Number(chosen.dataset.distance)).add(target);
    eye.add(move); target.add(move);
    control.setLookAt(eye.x, eye.y, eye.z, target.x, target.y, target.z, false);
    control.update(0.001);  // now, not with the next frame: where frames are slow the vehicle has gone on by then
    last = {name: chosen.dataset.name, at};
  };
  follow();
})

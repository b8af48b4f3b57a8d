"""What a test asks the page's 3-D canvas: where a point of the world is, what colours are seen, what stands in the scene."""

import time

COUNT = """(test) => {
  const canvas = window.__viserMutable.canvas, copy = document.createElement('canvas');
  copy.width = canvas.width; copy.height = canvas.height;
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0);
  const data = context.getImageData(0, 0, copy.width, copy.height).data, is = new Function('r', 'g', 'b', 'return ' + test);
  let n = 0;
  for (let i = 0; i < data.length; i += 4) if (is(data[i], data[i + 1], data[i + 2])) n++;
  return n;
}"""

PROJECT = """([a, b, c]) => {
  const page = window.__viserMutable, box = page.canvas.getBoundingClientRect(), camera = page.camera;
  const [w, x, y, z] = window.__viserSceneTree.getState()[''].wxyz;
  const tx = 2 * (y * c - z * b), ty = 2 * (z * a - x * c), tz = 2 * (x * b - y * a);
  const v = camera.position.clone().set(a + w * tx + (y * tz - z * ty), b + w * ty + (z * tx - x * tz), c + w * tz + (x * ty - y * tx));
  camera.updateMatrixWorld();
  v.project(camera);
  return [box.left + (v.x + 1) / 2 * box.width, box.top + (1 - v.y) / 2 * box.height];
}"""

TRACK = """(vehicle) => Object.entries(window.__viserSceneTree.getState())
  .filter(([name, node]) => name.startsWith(`/track/${vehicle}/`) && node)
  .reduce((n, [_, node]) => n + node.message.props.points.length, 0)"""
POSITION = "(name) => { const pose = window.__viserMutable.nodePoseData[name]; return pose ? [...pose.position] : null; }"

CAMERA_TO = """(name) => {
  const page = window.__viserMutable, node = page.nodeRefFromName[name];
  return page.camera.position.distanceTo(node.getWorldPosition(node.position.clone()));
}"""

TRACK_BLUE = "b > 190 && b - r > 60 && g > 100 && g < 220"


def pixels(page, test):
    """How many pixels of the canvas pass a test on r, g, b."""
    return page.evaluate(COUNT, test)


def on_screen(page, point):
    """(x, y) px of a point of the world [m]."""
    return page.evaluate(PROJECT, list(point))


def until(page, holds, seconds=40.0):
    """Whether ``holds()`` comes true in time; the page's own work goes on meanwhile."""
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            return False
        page.wait_for_timeout(100)
    return True

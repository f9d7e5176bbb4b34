// A run that plays: the robots' poses as they were recorded, on the arena as it was. Lengths are metres,
// times seconds.
'use strict';

const kSvg = 'http://www.w3.org/2000/svg';
const kRobotRadius = 0.085;  // of a foot-bot
const kColors = {kept: '#2b6cb0', lost: '#d1410c', guide: '#00856a', split: '#7b1fa2', plan: '#4a5560',
                 goal: '#e0a800', nest: '#8a94a0', food: '#00856a', beacon: '#b565c4'};
const replays = new Map();

function draw(parent, name, attributes) {
  const element = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent.append(element);
  return element;
}

const pointsOf = (points) => points.map((p) => p.join(',')).join(' ');

// Of the arena; the origin where it is not said.
const middleOf = (run) => run.center ?? [0, 0];

// Four bytes a pose: 12 bits for x and for y over the arena, 8 for the heading.
function unpack(run) {
  const bytes = Uint8Array.from(atob(run.poses), (letter) => letter.charCodeAt(0));
  const frames = [];
  const [middle_x, middle_y] = middleOf(run);
  for (let at = 0, frame = 0; frame < run.times.length; ++frame) {
    const robots = [];
    for (let robot = 0; robot < run.robots; ++robot, at += 4) {
      const x = bytes[at] | (bytes[at + 1] & 15) << 8;
      const y = bytes[at + 1] >> 4 | bytes[at + 2] << 4;
      robots.push([middle_x + (x / 4095 - 0.5) * run.side_x, middle_y + (y / 4095 - 0.5) * run.side_y,
                   (bytes[at + 3] / 256 - 0.5) * 2 * Math.PI]);
    }
    frames.push(robots);
  }
  if (frames.length > 0) frames[frames.length - 1] = run.last;  // to the last bit
  return frames;
}

// Whether the segments ab and cd cross.
function cross([ax, ay], [bx, by], [cx, cy], [dx, dy]) {
  const side = (px, py, qx, qy, rx, ry) => Math.sign((qx - px) * (ry - py) - (qy - py) * (rx - px));
  return side(ax, ay, bx, by, cx, cy) !== side(ax, ay, bx, by, dx, dy) &&
         side(cx, cy, dx, dy, ax, ay) !== side(cx, cy, dx, dy, bx, by);
}

// Whether nothing stands between two points outside of the obstacles.
const seesPast = (obstacles, a, b) =>
    !obstacles.some((box) => box.some((corner, i) => cross(a, b, corner, box[(i + 1) % box.length])));

class Replay {
  constructor(place, run) {
    this.run = run;
    this.frames = unpack(run);
    this.end = run.times[run.times.length - 1];
    this.time = 0;
    this.playing = false;
    this.makeControls(place);
    this.makePicture(place);
    this.showAt(0);
  }

  makeControls(place) {
    this.button = make('button', {type: 'button'}, 'Play');
    this.slider = make('input', {type: 'range', min: 0, max: this.end, step: 0.1, value: 0,
                                 'aria-label': 'Time in the run'});
    this.clock = make('output', {});
    this.speed = make('select', {}, ...[1, 4, 16, 64].map((x) => make('option', {value: x}, x + ' x')));
    this.speed.value = '16';
    this.trails = make('select', {}, make('option', {value: 0}, 'none'), make('option', {value: 20}, '20 s'),
                       make('option', {value: 1e9}, 'all'));
    this.trails.value = '20';
    this.button.addEventListener('click', () => (this.playing ? this.stop() : this.play()));
    this.slider.addEventListener('input', () => { this.stop(); this.showAt(Number(this.slider.value)); });
    this.trails.addEventListener('change', () => this.showAt(this.time));
    this.sight = make('input', {type: 'checkbox'});
    this.sight.addEventListener('change', () => this.showAt(this.time));
    const range = this.run.sight_range;
    const sight = range === null ? [] : [make('label', {}, this.sight, `who sees whom (within ${range.toFixed(2)} m)`)];
    place.append(make('div', {class: 'controls'}, this.button, this.slider, this.clock,
                      make('label', {}, 'speed', this.speed), make('label', {}, 'trails', this.trails),
                      ...sight),
                 make('p', {class: 'soft'}, 'Keys: space plays and pauses, arrows step by a second, with shift by ten.'));
  }

  // A key pressed anywhere on its page; true when it meant something.
  press(key, shift) {
    if (key === ' ') {
      if (this.playing) this.stop(); else this.play();
      return true;
    }
    if (key !== 'ArrowLeft' && key !== 'ArrowRight') return false;
    this.stop();
    const step = (shift ? 10 : 1) * (key === 'ArrowLeft' ? -1 : 1);
    this.showAt(Math.max(0, this.time + step));
    return true;
  }

  makePicture(place) {
    const run = this.run;
    const [w, h] = [run.side_x + run.wall, run.side_y + run.wall];
    const [x, y] = middleOf(run);
    const svg = draw(place, 'svg', {viewBox: [x - w / 2, -y - h / 2, w, h].join(' '), role: 'img',
                                    'aria-label': 'The arena from above'});
    const up = draw(svg, 'g', {transform: 'scale(1 -1)'});  // y goes up
    draw(up, 'rect', {x: x - run.side_x / 2, y: y - run.side_y / 2, width: run.side_x, height: run.side_y,
                      fill: 'none', stroke: '#3a424c', 'stroke-width': run.wall});
    for (const box of run.obstacles)
      draw(up, 'polygon', {points: pointsOf(box), fill: '#cbc4b6', stroke: '#857c6c', 'stroke-width': 0.015});
    for (const line of run.lines)
      draw(up, 'polyline', {points: pointsOf(line.points), fill: 'none', stroke: kColors[line.mark] ?? kColors.plan,
                            'stroke-width': 0.015, 'stroke-dasharray': '0.08 0.06'});
    for (const at of run.places) {
      const radius = Math.max(at.r, 0.05);
      draw(up, 'circle', {cx: at.x, cy: at.y, r: radius, fill: kColors[at.mark], 'fill-opacity': 0.35,
                          stroke: kColors[at.mark], 'stroke-width': 0.02});
      const label = draw(svg, 'text', {x: at.x, y: 0.2 - at.y + radius, 'text-anchor': 'middle', 'font-size': 0.17,
                                       fill: '#55606d'});
      label.textContent = at.label;
    }
    this.moments = run.moments.map((moment) => ({
      time: moment.time,
      mark: draw(up, 'circle', {cx: moment.x, cy: moment.y, r: Math.max(moment.r, 0.12), fill: 'none',
                                stroke: kColors[moment.mark] ?? kColors.split, 'stroke-width': 0.03,
                                'stroke-dasharray': '0.06 0.04', class: 'moment'})}));
    this.sights = draw(up, 'path', {fill: 'none', stroke: '#3a424c', 'stroke-width': 0.012, 'stroke-opacity': 0.55,
                                    class: 'sights'});
    const trails = draw(up, 'g', {fill: 'none', 'stroke-width': 0.025, 'stroke-opacity': 0.6});
    const colors = this.frames[0].map((_, i) => kColors[i === run.guide ? 'guide' : run.lost[i] ? 'lost' : 'kept']);
    this.ways = colors.map((color) => draw(trails, 'polyline', {stroke: color}));
    this.robots = colors.map((color, i) => {
      const robot = draw(up, 'g', {class: 'robot'});
      draw(robot, 'circle', {r: kRobotRadius, fill: color, stroke: '#ffffff', 'stroke-width': 0.012});
      draw(robot, 'line', {x1: 0, y1: 0, x2: kRobotRadius, y2: 0, stroke: '#ffffff', 'stroke-width': 0.025});
      const title = draw(robot, 'title', {});
      title.textContent = (i === run.guide ? run.guide_name : run.member + ' ' + i);
      return robot;
    });
    this.rings = run.trapped.map((one) => ({
      ...one, ring: draw(this.robots[one.robot], 'circle', {r: 0.14, fill: 'none', stroke: kColors.lost,
                                                            'stroke-width': 0.02})}));
  }

  // Poses between two recorded ones lie on the line between them.
  posesAt(time) {
    const times = this.run.times;
    let after = times.findIndex((one) => one >= time);
    if (after <= 0) return this.frames[after === 0 ? 0 : times.length - 1];
    if (times[after] === time) return this.frames[after];
    const share = (time - times[after - 1]) / (times[after] - times[after - 1]);
    return this.frames[after].map(([x, y, heading], i) => {
      const [x0, y0, heading0] = this.frames[after - 1][i];
      const turn = Math.atan2(Math.sin(heading - heading0), Math.cos(heading - heading0));
      return [x0 + share * (x - x0), y0 + share * (y - y0), heading0 + share * turn];
    });
  }

  showAt(time) {
    this.time = Math.min(time, this.end);
    const poses = this.posesAt(this.time);
    poses.forEach(([x, y, heading], i) => {
      this.robots[i].setAttribute('transform', `translate(${x} ${y}) rotate(${heading * 180 / Math.PI})`);
    });
    const from = this.time - Number(this.trails.value);
    const recorded = this.frames.filter((_, i) => this.run.times[i] >= from && this.run.times[i] < this.time);
    this.ways.forEach((way, i) => {
      const points = this.trails.value === '0' ? [] : [...recorded, poses].map((frame) => frame[i].slice(0, 2));
      way.setAttribute('points', pointsOf(points));
    });
    this.sights.setAttribute('d', this.sight.checked ? this.linesOfSight(poses) : '');
    for (const one of this.moments) one.mark.setAttribute('visibility', one.time <= this.time ? 'visible' : 'hidden');
    for (const one of this.rings) one.ring.setAttribute('visibility', one.time <= this.time ? 'visible' : 'hidden');
    this.slider.value = this.time;
    this.clock.textContent = `${this.time.toFixed(1)} of ${this.end.toFixed(1)} s`;
  }

  // A line between any two robots that are within range and have nothing between them.
  linesOfSight(poses) {
    const lines = [];
    poses.forEach((a, i) => poses.slice(0, i).forEach((b) => {
      if (Math.hypot(a[0] - b[0], a[1] - b[1]) > this.run.sight_range || !seesPast(this.run.obstacles, a, b)) return;
      lines.push(`M${a[0]},${a[1]}L${b[0]},${b[1]}`);
    }));
    return lines.join('');
  }

  play() {
    if (this.time >= this.end) this.showAt(0);
    this.playing = true;
    this.button.textContent = 'Pause';
    let before = performance.now();
    const step = (now) => {
      if (!this.playing) return;
      this.showAt(this.time + Number(this.speed.value) * Math.max(0, now - before) / 1000);
      before = now;
      if (this.time >= this.end) this.stop(); else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  stop() {
    this.playing = false;
    this.button.textContent = 'Play';
  }
}

function showReplay(page) {
  const place = page.querySelector('.replay');
  if (!place || replays.has(place)) return;
  replays.set(place, new Replay(place, data.replays[place.dataset.run]));
}

function stopReplaysBut(page) {
  for (const [place, replay] of replays) if (!page.contains(place)) replay.stop();
}

addEventListener('keydown', (event) => {
  const replay = replays.get(document.querySelector('.page.shown .replay'));
  // What has the focus comes first: a button is pressed by space, a slider and a list move by arrows.
  if (!replay || event.target.closest('button, select, input, summary, a') || event.ctrlKey || event.altKey ||
      event.metaKey) return;
  if (replay.press(event.key, event.shiftKey)) event.preventDefault();
});

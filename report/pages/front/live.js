// What campaigns do now: asked every second, shown on the live page, and told above every page when it
// concerns the reader.
'use strict';

const kMilliseconds = 1000;
const kWorkersAtATime = 50;
const kStates = {starting: 'is starting', running: 'is running', stopping: 'is stopping', stopped: 'stands still',
                 finished: 'has finished'};
// Workers that need somebody to look at them come first.
const kWorkerStates = ['quarantined', 'lost', 'leaving', 'running', 'idle'];

const grouped = (number) => number.toLocaleString('en-US');

function duration(seconds) {
  if (seconds < 60) return Math.ceil(seconds) + ' s';
  const minutes = Math.round(seconds / 60);
  return minutes < 60 ? minutes + ' min' : Math.floor(minutes / 60) + ' h ' + minutes % 60 + ' min';
}

function table(headers, rows) {
  const atRight = headers.map((header) => header.startsWith('>'));
  const cell = (name, content, i) => make(name, {class: atRight[i] ? 'number' : ''}, content);
  return make('div', {class: 'scroll'}, make('table', {},
      make('thead', {}, make('tr', {}, ...headers.map((one, i) => cell('th', one.replace(/^>/, ''), i)))),
      make('tbody', {}, ...rows.map((row) => make('tr', {}, ...row.map((one, i) => cell('td', one, i)))))));
}

class LiveView {
  constructor(place) {
    this.campaign = Number(place.dataset.campaign);
    this.shownWorkers = kWorkersAtATime;
    const part = (name, attributes) => place.appendChild(make(name, attributes));
    this.headline = part('p', {class: 'verdict', role: 'status'});
    this.progress = part('progress', {max: 1, 'aria-label': 'Runs done'});
    this.why = part('p', {class: 'notes'});
    this.facts = part('div', {});
    this.figures = part('div', {});
    this.jobs = part('div', {});
    this.workers = part('div', {class: 'workers'});
    this.more = part('button', {type: 'button'});
    this.more.textContent = 'Show more workers';
    this.more.addEventListener('click', () => {
      this.shownWorkers += kWorkersAtATime;
      this.showWorkers(this.status);
    });
    this.events = part('div', {});
  }

  update(now) {
    this.status = now.status;
    const status = now.status;
    this.showHeadline(status);
    const why = status.why_nothing_runs ?? status.pool_trouble;
    this.why.hidden = !why || status.state === 'finished';
    this.why.textContent = why ? 'Nothing runs: ' + why.replace(' DIR`', ' ' + data.campaigns[this.campaign].directory + '`') : '';
    this.showFacts(now);
    this.showFigures(now);
    this.showJobs(status);
    this.showWorkers(status);
    this.showEvents(now.events);
  }

  showHeadline(status) {
    const planned = status.runs_planned ?? 0;
    const parts = [`The campaign ${kStates[status.state] ?? status.state}`];
    if (status.searches_in_words) parts.push(status.searches_in_words);
    if (status.runs_done !== undefined)
      parts.push(grouped(status.runs_done) + (planned ? ' of ' + grouped(planned) : '') + ' runs');
    if (status.runs_per_second) parts.push(`${status.runs_per_second.toFixed(1)} runs/s`);
    if (status.remaining_seconds != null && status.state === 'running')
      parts.push(`about ${duration(status.remaining_seconds)} left`);
    this.headline.textContent = parts.join(', ') + '.';
    this.progress.hidden = !planned;
    this.progress.value = planned ? status.runs_done / planned : 0;
  }

  showFacts(now) {
    const status = now.status;
    const rows = [];
    const count = (name, value) => { if (value) rows.push([name, grouped(value)]); };
    count('total failures', status.total_failures);
    count('runs without a result', status.runs_failed);
    if (now.toughest) {
      const link = make('a', {href: `#run-${this.campaign}-${now.toughest.run}`}, 'run ' + runText(now.toughest.run));
      rows.push(['toughest so far', make('span', {}, link, `, fitness ${now.toughest.fitness.toFixed(3)}`)]);
    }
    count('workers', status.workers);
    count('of them busy', status.workers_busy);
    count('lost', status.workers_lost);
    count('quarantined', status.workers_quarantined);
    count('runs being simulated', status.runs_running);
    count('runs waiting', (status.runs_queued ?? 0) + (status.runs_ahead ?? 0));
    count('leased again, after a loss', status.leased_again);
    count('runs that ended differently on two workers', status.nondeterministic);
    if (status.master) {
      const silence = status.status_age_seconds > 5 ? `, silent for ${duration(status.status_age_seconds)}` : '';
      rows.push(['master', `process ${status.master.pid} on ${status.master.host}${silence}`]);
    }
    const body = rows.map(([name, value]) => make('tr', {}, make('th', {scope: 'row'}, name), make('td', {}, value)));
    this.facts.replaceChildren(make('div', {class: 'scroll'}, make('table', {class: 'facts'}, make('tbody', {}, ...body))));
  }

  // The pictures of how the searches go; asked for again when there are more runs.
  showFigures(now) {
    const runs = now.status.runs_done ?? 0;
    while (this.figures.children.length < Math.min(now.courses, 4)) {
      const image = make('img', {alt: 'How the search goes: fitness and total failures over the runs spent'});
      this.figures.append(make('figure', {}, make('div', {class: 'scroll'}, image), make('figcaption', {},
          'Above: fitness of the runs, the lowest (toughest) and the mean; a search that learns drives it down. ' +
          'Below: how many of them were total failures.')));
    }
    if (runs === this.drawnRuns) return;
    this.drawnRuns = runs;
    [...this.figures.querySelectorAll('img')].forEach((image, i) => {
      image.src = `progress/${this.campaign}/${i}?runs=${runs}`;
    });
  }

  showJobs(status) {
    const jobs = status.allocations ?? [];
    this.jobs.replaceChildren(...(jobs.length === 0 ? [] : [make('h3', {}, 'Jobs'),
        table(['job', 'state', 'reason', 'node', '>workers'],
              jobs.map((job) => [job.job, job.state, job.reason, job.nodes, grouped(job.workers)]))]));
  }

  showWorkers(status) {
    const order = (worker) => kWorkerStates.indexOf(worker.state);
    const workers = [...status.worker_list].sort((a, b) => order(a) - order(b));
    const runsOf = (worker) => {
      const waiting = worker.runs.filter((run) => run.state === 'waiting').map((run) => run.run);
      const running = worker.runs.filter((run) => run.state !== 'waiting')
          .map((run) => `${runText(run.run)} (${run.seconds.toFixed(1)} s)`);
      return [...running, ...(waiting.length ? ['next ' + runRanges(waiting)] : [])].join(', ');
    };
    const rows = workers.slice(0, this.shownWorkers).map((worker) => [
      worker.worker, worker.state + (worker.quarantined ? ': ' + worker.quarantined : ''),
      worker.silent_seconds.toFixed(1) + ' s', grouped(worker.runs_finished ?? 0), runsOf(worker)]);
    this.workers.replaceChildren(...(rows.length === 0 ? [] : [
      make('h3', {}, 'Workers'), table(['worker', 'state', '>heard', '>runs done', 'simulates'], rows)]));
    this.more.hidden = workers.length <= this.shownWorkers;
    const others = Object.entries(status.workers_not_listed ?? {}).filter(([, count]) => count > 0);
    if (this.more.hidden && others.length > 0)
      this.workers.append(make('p', {}, 'and ' + others.map(([state, count]) => `${grouped(count)} ${state}`).join(', ')));
  }

  showEvents(events) {
    const newest = events.length === 0 ? '' : events[events.length - 1].unix_ms + ' ' + events.length;
    if (newest === this.newestEvent) return;
    this.newestEvent = newest;
    const time = (ms) => new Date(ms).toISOString().replace('T', ' ').slice(0, 19);
    this.events.replaceChildren(make('h3', {}, 'Events'), table(['time (UTC)', 'what happened'],
        [...events].reverse().map((event) => [time(event.unix_ms), event.text || event.kind])));
  }
}

// What a reader has to know on any page: a sentence for each campaign, and a button where it helps.
function tell(place, sentences, stale) {
  const items = sentences.map((sentence) => make('li', {}, sentence));
  if (stale) {
    const button = make('button', {type: 'button'}, 'Read them');
    button.addEventListener('click', () => location.reload());
    items.push(make('li', {}, stale + ' ', button));
  }
  const text = items.map((item) => item.textContent).join();
  if (place.dataset.text === text) return;
  place.dataset.text = text;
  place.replaceChildren(...(items.length === 0 ? [] : [make('ul', {class: 'notes'}, ...items)]));
}

function startLive() {
  const views = [...document.querySelectorAll('.live')].map((place) => new LiveView(place));
  const news = make('div', {id: 'news', role: 'status'});
  document.querySelector('nav').after(news);
  const look = async () => {
    try {
      const now = await ask('status');
      const sentences = [];
      let more = 0;
      let begun = '';
      now.campaigns.forEach((one, i) => {
        if (data.campaigns[i]?.directory !== one.directory) {
          begun = `${one.directory} has begun since these pages were read.`;
          return;
        }
        if (one.error) sentences.push(one.error + '. What stands here was read before.');
        if (!one.status) return;
        views[i].update(one);
        more += Math.max(0, (one.status.runs_done ?? 0) - data.campaigns[i].runs_done);
      });
      tell(news, sentences, begun || (more > 0 ? `${grouped(more)} more runs are stored than these pages tell of.` : ''));
    } catch (trouble) {
      tell(news, ['Nobody serves these pages any more. Start `gauntlet ui` again and open the address that it ' +
                  'prints; what stands here was read before.'], '');
    }
    setTimeout(look, kMilliseconds);
  };
  look();
}
if (data.served) startLive();

show();

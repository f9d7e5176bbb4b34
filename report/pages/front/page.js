// The pages of a report: which one is shown, tables that sort and filter, buttons that copy. Everything that
// must be readable without this file stands in the document already.
'use strict';

const data = JSON.parse(document.getElementById('data').textContent);
document.documentElement.classList.add('js');

// An element with attributes and children; texts are texts, whatever they hold.
function make(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

// A run as people name it: "15", and "2:15" of a campaign's second search.
const kSequences = 2 ** 40;
function runText(id) {
  const run = Number(id);
  return run < kSequences ? String(run) : `${Math.floor(run / kSequences) + 1}:${run % kSequences}`;
}

// "3 to 40, 2:7".
function runRanges(ids) {
  const ranges = [];
  for (const id of ids.map(Number).sort((a, b) => a - b)) {
    const last = ranges[ranges.length - 1];
    if (last && last[1] + 1 === id) last[1] = id; else ranges.push([id, id]);
  }
  return ranges.map(([first, last]) => first === last ? runText(first) : `${runText(first)} to ${runText(last)}`).join(', ');
}

// --- which page is shown: the one that the address names, or that holds what it names

function show() {
  const name = decodeURIComponent(location.hash.slice(1));
  if (mustBeFetched(name)) {
    fetchRun(name);
    return;
  }
  const pages = [...document.querySelectorAll('.page')];
  const wanted = document.getElementById(name);
  const page = (wanted && wanted.closest('.page')) || pages[0];
  for (const one of pages) one.classList.toggle('shown', one === page);
  for (const link of document.querySelectorAll('nav a')) {
    const here = link.hash === '#' + page.id || (link.dataset.page === 'case' && page.classList.contains('case'));
    if (here) link.setAttribute('aria-current', 'page'); else link.removeAttribute('aria-current');
  }
  if (page.classList.contains('case')) showReplay(page);
  stopReplaysBut(page);
  if (wanted && wanted !== page) wanted.scrollIntoView(); else scrollTo(0, 0);
}
addEventListener('hashchange', show);

// --- buttons that copy

function addCopyButtons(place) {
  for (const command of place.querySelectorAll('.command')) {
    const button = make('button', {type: 'button'}, 'Copy');
    button.addEventListener('click', async () => {
      const text = command.querySelector('code').textContent;
      try {
        await navigator.clipboard.writeText(text);
      } catch (refused) {  // from a file, some browsers allow only the old way
        const area = make('textarea');
        area.value = text;
        document.body.append(area);
        area.select();
        document.execCommand('copy');
        area.remove();
      }
      button.textContent = 'Copied';
      setTimeout(() => { button.textContent = 'Copy'; }, 1500);
    });
    command.append(button);
  }
}
addCopyButtons(document);

// --- the table of all cases

const kRowsAtATime = 100;

function caseTable(place) {
  const campaign = data.campaigns[Number(place.dataset.campaign)];
  const at = Object.fromEntries(campaign.case_columns.map((column, i) => [column.key, i]));
  // A column without any value tells nothing, nor does the number of the only search.
  const columns = campaign.case_columns.filter(({key}) => campaign.cases.some((row) =>
      row[at[key]] !== null && (key !== 'search' || row[at[key]] !== 1)));
  let shown = kRowsAtATime;
  let sorted = null;  // by the report: the toughest first
  let falling = false;

  const text = make('input', {type: 'search', 'aria-label': 'Filter cases', placeholder: 'number, name, ...'});
  const kind = make('select', {'aria-label': 'Which cases'}, make('option', {value: ''}, 'all cases'),
                    make('option', {value: 'failing'}, 'with a total failure'));
  if (!data.served) kind.append(make('option', {value: 'shown'}, 'with a replay here'));
  campaign.failure_types.forEach((type) => kind.append(make('option', {value: 'type ' + type}, type)));
  const count = make('output', {});
  const more = make('button', {type: 'button'}, 'Show more');
  const head = make('tr');
  const body = make('tbody');
  columns.forEach((column) => {
    const button = make('button', {type: 'button'}, column.title);
    button.addEventListener('click', () => {
      falling = sorted === at[column.key] ? !falling : false;
      sorted = at[column.key];
      fill();
    });
    head.append(make('th', {scope: 'col', class: column.number ? 'number' : ''}, button));
  });

  function wanted(row) {
    if (kind.value === 'failing' && row[at.failures] === 0) return false;
    if (kind.value === 'shown' && !row[at.run]) return false;
    if (kind.value.startsWith('type ') && row[at.type] !== kind.value.slice(5)) return false;
    const word = text.value.trim().toLowerCase();
    return word === '' || row.some((cell, i) => cell !== null && cellText(i, cell).toLowerCase().includes(word));
  }
  function fill() {
    const rows = campaign.cases.filter(wanted);
    if (sorted !== null) {
      rows.sort((a, b) => {
        const x = a[sorted], y = b[sorted];
        if (x === null || y === null) return (x === null) - (y === null);  // what is missing comes last
        const order = typeof x === 'number' ? x - y : String(x).localeCompare(String(y));
        return falling ? -order : order;
      });
    }
    [...head.children].forEach((cell, i) => {
      if (at[columns[i].key] === sorted) cell.setAttribute('aria-sort', falling ? 'descending' : 'ascending');
      else cell.removeAttribute('aria-sort');
    });
    body.replaceChildren(...rows.slice(0, shown).map((row) => {
      const line = make('tr');
      columns.forEach((column) => {
        const cell = make('td', {class: column.number ? 'number' : ''});
        const value = row[at[column.key]];
        if (value !== null) cell.append(linked(column, value));
        line.append(cell);
      });
      return line;
    }));
    count.textContent = rows.length + ' of ' + campaign.cases.length + ' cases';
    more.hidden = rows.length <= shown;
  }
  function cellText(place, value) {
    return place === at.run ? runText(value) : String(value);
  }
  function linked(column, value) {
    const id = 'run-' + place.dataset.campaign + '-' + value;
    const text = cellText(at[column.key], value);
    if (column.key !== 'run' || !(data.served || document.getElementById(id))) return text;
    return make('a', {href: '#' + id}, text);
  }
  at.type = at.type ?? -1;
  text.addEventListener('input', () => { shown = kRowsAtATime; fill(); });
  kind.addEventListener('change', () => { shown = kRowsAtATime; fill(); });
  more.addEventListener('click', () => { shown += kRowsAtATime; fill(); });
  fill();
  place.replaceChildren(make('div', {class: 'controls'}, text, kind, count, ...anyRun(place.dataset.campaign)),
                        make('div', {class: 'scroll'}, make('table', {}, make('thead', {}, head), body)),
                        more);
}

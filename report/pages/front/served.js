// What only pages have that are served: every run of the campaign, simulated again when somebody wants to see
// it.
'use strict';

const kRunId = /^run-(\d+)-(\d+)$/;

// A JSON document of the server; its words as an error when it refuses.
async function ask(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error((await answer.text()).trim());
  return answer.json();
}

// Whether the address names a run whose page is not here, or could not be had the last time.
function mustBeFetched(name) {
  const page = document.getElementById(name);
  return data.served && kRunId.test(name) && (page === null || page.dataset.refused !== undefined);
}

async function fetchRun(name) {
  const [, campaign, run] = kRunId.exec(name);
  document.getElementById(name)?.remove();
  const title = make('h2', {}, 'Run ' + runText(run));
  const page = make('section', {class: 'page case', id: name}, title,
                    make('p', {role: 'status'}, 'The run is simulated again ...'));
  document.querySelector('main').append(page);
  show();
  try {
    const answer = await ask(`run/${campaign}/${run}`);
    if (answer.replay) data.replays[name] = answer.replay;
    page.outerHTML = answer.page;
    addCopyButtons(document.getElementById(name));
    show();
  } catch (trouble) {
    page.dataset.refused = '';
    page.replaceChildren(title, make('p', {class: 'notes', role: 'alert'}, trouble.message));
  }
}

// Where the number of any run can be typed.
function anyRun(campaign) {
  if (!data.served) return [];
  const number = make('input', {pattern: '[0-9]+(:[0-9]+)?', required: '', 'aria-label': 'Number of a run, or SEARCH:RUN',
                                title: 'the number of a run, or SEARCH:RUN'});
  const form = make('form', {class: 'controls any-run'}, make('label', {}, 'run', number),
                    make('button', {}, 'Replay'));
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    const [run, search] = number.value.split(':').map(Number).reverse();
    location.hash = `run-${campaign}-${((search ?? 1) - 1) * kSequences + run}`;
  });
  return [form];
}

document.querySelectorAll('.all-cases').forEach(async (place) => {
  const campaign = data.campaigns[Number(place.dataset.campaign)];
  try {
    campaign.cases ??= await ask(`cases/${place.dataset.campaign}`);
    caseTable(place);
  } catch (trouble) {
    place.append(make('p', {class: 'notes', role: 'alert'}, trouble.message));
  }
});

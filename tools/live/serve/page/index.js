'use strict';
// What the server is asked for needs the token, if it has one; viewers may need a ticket, which the
// token makes.
const element = (id) => document.getElementById(id);
const kLook = 1000;  // milliseconds
let shown = '';

function headers() {
  const token = sessionStorage.getItem('token');
  return token ? {Authorization: `Bearer ${token}`} : {};
}

async function ask(path, options = {}) {
  const answer = await fetch(path, {cache: 'no-store', ...options, headers: headers()});
  element('access').hidden = answer.status !== 401;
  const text = await answer.text();
  if (!answer.ok) {
    let why = text;
    try { why = JSON.parse(text).error; } catch { /* it is a text */ }
    throw new Error(why);
  }
  return JSON.parse(text);
}

function tell(text) {
  if (element('state').textContent !== text) element('state').textContent = text;
}

async function show(name) {
  shown = name;
  let path = `heads/${name}/?controls`;
  try {
    const {ticket} = await ask(`heads/${name}/ticket`, {method: 'POST', body: ''});
    path += `&ticket=${ticket}`;
  } catch { /* a server without a token has no tickets, and needs none */ }
  element('frame').src = path;
  element('shown').hidden = false;
  for (const row of element('heads').rows) row.ariaSelected = String(row.dataset.name === name);
}

function row(head) {
  const line = document.createElement('tr');
  line.dataset.name = head.name;
  line.ariaSelected = String(head.name === shown);
  const open = document.createElement('button');
  open.textContent = head.name;
  open.addEventListener('click', () => show(head.name));
  const cells = [open, head.viewers, head.lines_waiting,
      head.asleep ? 'asleep' : `${head.late_99_ms} ms`];
  for (const content of cells) {
    const cell = document.createElement('td');
    cell.append(content);
    line.append(cell);
  }
  return line;
}

async function look() {
  try {
    const {heads, viewers} = await ask('heads');
    element('heads').replaceChildren(...heads.map(row));
    element('none').hidden = heads.length > 0;
    tell(`${heads.length} heads, ${viewers} viewers`);
  } catch (problem) {
    tell(problem.message);
  }
}

async function say(body) {
  try {
    await ask(`heads/${shown}/say`, {method: 'POST', body});
  } catch (problem) {
    tell(problem.message);
  }
}

element('access').addEventListener('submit', (event) => {
  event.preventDefault();
  sessionStorage.setItem('token', element('token').value);
  look();
});
element('speech').addEventListener('submit', (event) => {
  event.preventDefault();
  say(JSON.stringify({do: 'say', text: element('text').value}));
  element('text').value = '';
});
element('stop').addEventListener('click', () => say('{"do": "stop"}'));
look();
setInterval(look, kLook);

// tabs.js: the tabs; the panel of each is a group of controls. A tab is shown if its panel has something for the pack.
// ?tab=speech opens a tab; ?tab=all shows all panels one below the other, without tabs. Also the number of characters,
// and the link to the crowd.
'use strict';

const tabs = [...document.querySelectorAll('[role=tab]')];
const panelOf = (tab) => byId(tab.getAttribute('aria-controls'));
const has = (tab) => [...panelOf(tab).children].some((section) => !section.hidden);

function showTab(chosen) {
    for (const tab of tabs) {
        tab.setAttribute('aria-selected', String(tab === chosen));
        tab.tabIndex = tab === chosen ? 0 : -1;
        panelOf(tab).hidden = tab !== chosen;
    }
}

// After a pack is loaded.
function listTabs() {
    if (byId('tabs').hidden) return;
    for (const tab of tabs) tab.hidden = !has(tab);
    byId('tabs').style.setProperty('--columns', Math.ceil(tabs.filter((tab) => !tab.hidden).length / 2)); // two rows
    const chosen = tabs.find((tab) => tab.getAttribute('aria-selected') === 'true');
    if (!chosen || chosen.hidden) showTab(tabs.find((tab) => !tab.hidden));
}

const moves = { ArrowLeft: (i, n) => (i + n - 1) % n, ArrowRight: (i, n) => (i + 1) % n, Home: () => 0, End: (i, n) => n - 1 };
byId('tabs').addEventListener('keydown', (event) => {
    const there = tabs.filter((tab) => !tab.hidden), at = there.indexOf(document.activeElement);
    if (!moves[event.key] || at < 0) return;
    event.preventDefault();
    const next = there[moves[event.key](at, there.length)];
    showTab(next);
    next.focus();
});
for (const tab of tabs) tab.addEventListener('click', () => showTab(tab));

byId('tabs').hidden = query.get('tab') === 'all';
if (!byId('tabs').hidden) showTab(byId(`tab-${query.get('tab')}`) || tabs[0]);

// ---- several characters ----

// Memory is planned for their number, so the pack is opened again.
async function showSeveral() {
    if (opening || !window.noh.whole || character.lost) return;
    opening = fresh = true;
    character.wants.characters = Number(byId('several').value);
    await load(again()).catch((error) => say(`so many cannot be shown: ${error.message || error}`));
    opening = false;
}
for (let i = 1; i <= 16; i++) byId('several').add(new Option(i === 1 ? 'one' : i, i));
byId('several').value = query.get('actors') || 1;
byId('several').addEventListener('change', showSeveral);

// ---- the crowd ----

byId('crowd').addEventListener('click', async () => {
    const answer = await fetch('festival/index.html', { method: 'HEAD' }).catch(() => ({ ok: false }));
    if (answer.ok) location.href = 'festival/';
    else byId('crowd-text').textContent = 'The crowd is not on this server. Who builds the page adds it with make web-festival.';
});

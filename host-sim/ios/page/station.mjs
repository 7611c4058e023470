/* The instructor's page. It says what the bus says, and asks for nothing but by frames of the bus. */
import {Commands} from './commands.mjs';
import {find, make, rows, saveAs, say} from './dom.mjs';
import {csvOf} from './events.mjs';
import {ID, Reader, STATION_NODE} from './frames.mjs';
import {clockWords, NAUTICAL_MILE_M, placeWords} from './geo.mjs';
import {Keeper} from './keeper.mjs';
import {displayLayer, handleAt, ownLayer, targetLayer, weatherLayer} from './layers.mjs';
import {Link} from './link.mjs';
import {MovingMap} from './map.mjs';
import {ClockPanel} from './panel_clock.mjs';
import {DisplaysPanel} from './panel_displays.mjs';
import {MalfunctionsPanel} from './panel_malfunctions.mjs';
import {TargetsPanel} from './panel_targets.mjs';
import {WeatherPanel} from './panel_weather.mjs';
import {DEAD_US, OWN_DEAD_US, OWN_STALE_US, World} from './world.mjs';

const TICK_MS = 50, RENDER_MS = 200, DRAW_MS = {calm: 1000, usual: 100}, MESSAGE_MS = 8000;
const CLOCK_STEP_US = 2e6, SNAPSHOT_END = 0x7ff, EVENTS_SHOWN = 200;

class Station {
    async start() {
        const [site, bounds] = await Promise.all(['station.json', 'map.json'].map((url) => this.json(url)));
        this.node = Number(new URLSearchParams(location.search).get('node')) || STATION_NODE;
        this.world = new World();
        this.reader = new Reader();
        this.past = [];
        this.offsetUs = null; // of the bus's clock from the page's
        this.keeper = new Keeper({send: (lines) => this.send(lines), nowMs: () => performance.now(), node: this.node});
        this.commands = new Commands(this.world, this.keeper);
        this.site = site;
        this.makeMap(bounds);
        this.panels = [new TargetsPanel(this), new WeatherPanel(this), new MalfunctionsPanel(this),
            new ClockPanel(this),
            new DisplaysPanel(this, site.displays ?? [])];
        [this.targets, this.weather, , , this.displays] = this.panels;
        this.makeTabs();
        this.setOpen(false);
        this.link = new Link(this.address('bus'), {frames: (frames) => this.take(frames),
            refused: (text) => this.refused(text),
            state: (isOpen) => this.setOpen(isOpen)});
        setInterval(() => this.tick(), TICK_MS);
        requestAnimationFrame((ms) => this.draw(ms));
    }

    async json(url) {
        const answer = await fetch(url);
        if (!answer.ok) {
            throw new Error(`${url}: the server answers ${answer.status}`);
        }
        return answer.json();
    }

    address(path) {
        return new URL(path, location.href.replace(/^http/, 'ws').replace(/[?#].*$/, '')).href;
    }

    /* ---- connection ---- */

    setOpen(isOpen) {
        const wasOpen = this.isOpen;
        this.isOpen = isOpen;
        const maySend = this.maySend();
        document.body.classList.toggle('is-lost', !isOpen);
        document.querySelectorAll('fieldset.commands').forEach((set) => { set.disabled = !maySend; });
        say(find('connection'),
            isOpen ? `Connected to ${this.site.bus ?? 'the bus'}${maySend ? '' : ', listening only'}`
                : 'NO CONNECTION');
        say(find('lost'),
            isOpen ? '' : wasOpen ? 'Connection lost. What is shown is what was, and nothing can be told. Trying again.'
            : 'No connection yet. Trying.');
        if (wasOpen !== undefined && wasOpen !== isOpen) {
            this.world.event(isOpen ? 'connected' : 'connection lost', 'this page');
        }
    }

    maySend() {
        return this.isOpen && this.site.may_send !== false;
    }

    /* What the server does not put on the bus is not asked for again. */
    refused(text) {
        const keys = this.keeper.dropUnheard();
        this.report(`the server refuses${keys.length > 0 ? ` ${keys.join(', ')}` : ''}: ${text}`);
    }

    send(lines) {
        if (!this.link?.send(lines)) {
            this.report('not sent: no connection');
        }
    }

    /* ---- the bus ---- */

    take(frames) {
        for (const frame of frames) {
            const isEnd = frame.isPast && frame.id === SNAPSHOT_END;
            if (!frame.isPast || isEnd) {
                this.follow(frame.timeUs);
                this.endSnapshot();
            }
            if (frame.isPast && !isEnd) {
                this.past.push(frame);
            } else {
                this.hear(frame, false);
            }
        }
        this.tick();
    }

    /* The bus's clock, of the stamps: they come late, never early. */
    follow(stampUs) {
        const offsetUs = stampUs - 1000 * performance.now();
        if (this.offsetUs !== null && this.offsetUs - offsetUs > CLOCK_STEP_US) {
            this.world.restart(stampUs); // a log that begins anew
        }
        if (this.offsetUs === null || offsetUs > this.offsetUs || this.offsetUs - offsetUs > CLOCK_STEP_US) {
            this.offsetUs = offsetUs;
        }
    }

    /* The snapshot is heard in the order in which it was on the bus; what the displays have dropped is left out. */
    endSnapshot() {
        const nowUs = this.offsetUs + 1000 * performance.now();
        const isAlive = ({id, timeUs}) => nowUs - timeUs < DEAD_US || (id >= ID.exerciseTime && id <= ID.exerciseSeed);
        const past = this.past.splice(0).filter(isAlive).sort((a, b) => a.timeUs - b.timeUs);
        past.forEach((frame) => this.hear(frame, true));
    }

    hear(frame, isPast) {
        this.world.nowUs = Math.max(this.world.nowUs, isPast ? 0 : frame.timeUs);
        for (const fact of this.reader.take(frame)) {
            const isOwn = this.keeper.isOwn(fact);
            const by = isPast ? null : isOwn ? 'this page' : fact.node === this.node ? 'another page'
                : `node ${fact.node}`;
            const isHeard = this.world.take(fact, by), lost = fact.what === 'own' ? null
                : this.keeper.hear(fact, isHeard);
            if (lost !== null) {
                this.report(isHeard ? `another instructor has ${lost} now` : `${lost}: the displays hear another node`);
            }
        }
    }

    /* Who repeats a thing: for words. */
    toldBy(key, thing) {
        const who = this.keeper.kept.has(key) ? 'this page' : thing.node === this.node ? 'another page'
            : `node ${thing.node}`;
        return this.world.isStale(thing) ? `${who}, SILENT` : who;
    }

    /* ---- time ---- */

    tick() {
        if (this.offsetUs === null || !this.isOpen) {
            return;
        }
        this.world.tick(this.offsetUs + 1000 * performance.now());
        if (this.maySend()) {
            this.commands.tick();
        }
        if (performance.now() - (this.renderedMs ?? -Infinity) > RENDER_MS) {
            this.render();
        }
    }

    changed() {
        this.isDirty = true;
    }

    render() {
        this.renderedMs = performance.now();
        this.panels.forEach((panel) => panel.render());
        this.renderOwn();
        this.renderEvents();
        this.isDirty = true;
    }

    renderOwn() {
        const own = this.world.ownAircraft(), ageUs = own?.ageUs ?? Infinity;
        const state = !own ? 'No own aircraft on the bus' : ageUs > OWN_DEAD_US
            ? `Own aircraft LOST, ${(ageUs / 1e6).toFixed(0)} s ago at`
            : ageUs > OWN_STALE_US ? `Own aircraft STALE, ${(ageUs / 1e6).toFixed(1)} s ago at` : 'Own aircraft';
        const parts = own ? [placeWords(own), own.headingDeg === null ? '' : `heading ${own.headingDeg.toFixed(0)}°`,
            own.heightM === null ? '' : `${own.heightM.toFixed(0)} m`,
                own.speedMs === null ? '' : `${own.speedMs.toFixed(0)} m/s`] : [];
        say(find('own'), [state, ...parts.filter((words) => words !== '')].join(', ').replace(' at,', ' at'));
        find('own').classList.toggle('is-stale', ageUs > OWN_STALE_US);
        const {world, map} = this;
        const range = (map.canvas.clientWidth * map.metresPerPixel() / NAUTICAL_MILE_M).toFixed(0);
        const around = `Map of ${range} NM across around ${placeWords(map.centerPlace)}: ${find('own').textContent}`;
        say(find('map-words'), `${around}; ${world.targets.size} live targets, ${world.rain.size} circles of rain, `
            + `${world.jammer.size} jammers. The lists beside it have them in words.`);
    }

    renderEvents() {
        const {events} = this.world;
        if (events.at(-1) === this.shownEvent) {
            return;
        }
        this.shownEvent = events.at(-1);
        events.forEach((event) => { event.key ??= this.eventKey = (this.eventKey ?? 0) + 1; });
        const newest = events.slice(-EVENTS_SHOWN).reverse();
        rows(find('events'), newest, () => make('li', {}, make('time', {}), ' ', make('span', {class: 'what'}), ' ',
            make('span', {class: 'by'})), (row, event) => {
            const utc = new Date(event.busUs / 1000).toISOString().slice(11, 19);
            say(row.querySelector('time'), event.exerciseMs === null ? `${utc} UTC` : clockWords(event.exerciseMs));
            row.querySelector('time').title = `${utc} on the bus`;
            say(row.querySelector('.what'), event.text);
            say(row.querySelector('.by'), event.by === 'nobody' ? '' : `(${event.by})`);
        });
    }

    saveEvents() {
        const {events} = this.world, now = new Date(events.at(-1)?.busUs / 1000 || Date.now());
        const name = `events-${now.toISOString().slice(0, 19).replace(/\D/g, '-')}.csv`;
        this.saved = saveAs(name, new Blob([csvOf(events)], {type: 'text/csv'}));
    }

    /* Something that the instructor must know now. */
    report(text) {
        say(find('message'), text);
        clearTimeout(this.messageTimer);
        this.messageTimer = setTimeout(() => say(find('message'), ''), MESSAGE_MS);
    }

    /* ---- map ---- */

    makeMap(bounds) {
        this.tool = () => document.querySelector('input[name="tool"]:checked').value;
        this.map = new MovingMap(find('map'), bounds, {act: (place, handle) => this.act(place, handle),
            grab: (place, nearM) => this.grab(place, nearM),
            drop: (handle, place) => this.drop(handle, place), key: (key) => this.mapKey(key),
                changed: () => this.changed()});
        const grabbedOf = (what, number) => this.map.grabbed?.what === what && this.map.grabbed.number === number
            ? this.map.grabbed.place : undefined;
        this.layers = [weatherLayer(this.world, grabbedOf), displayLayer(this.world),
            targetLayer(this.world, {chosen: () => this.targets.chosen, grabbedOf,
                routeOf: (number) => this.targets.routeOf(number)}), ownLayer(this.world)];
        this.map.isFollowing = true;
        find('map-follow').checked = true;
        find('map-follow').addEventListener('change', () => { this.map.isFollowing = find('map-follow').checked; });
        const acts = {'map-in': () => this.map.zoomBy(0.5), 'map-out': () => this.map.zoomBy(-0.5),
            'map-whole': () => this.map.wholeMap(), 'events-save': () => this.saveEvents()};
        Object.entries(acts).forEach(([id, act]) => find(id).addEventListener('click', act));
    }

    grab(place, nearM) {
        return this.tool() === 'look' ? handleAt(this.world, place, nearM) : null;
    }

    /* A click on the map, or Enter: what the chosen tool does there. */
    act(place, handle) {
        const tool = this.tool();
        if (tool === 'look') {
            this.targets.choose(handle?.what === 'target' ? handle.number : null);
        } else if (this.maySend()) {
            const acts = {target: () => this.targets.place(place), route: () => this.targets.waypoint(place),
                rain: () => this.weather.place('rain', place),
                jammer: () => this.weather.place('jammer', place), cursor: () => this.displays.at('cursor', place),
                steer: () => this.displays.at('steer', place), patch: () => this.displays.at('patch', place)};
            acts[tool]();
        } else {
            this.report('nothing can be told now');
        }
    }

    drop({what, number}, place) {
        if (what === 'target') {
            this.targets.move(number, place);
        } else {
            this.weather.move(what, number, place);
        }
    }

    /* Keys of the map beside those that move it. True where the key meant something. */
    mapKey(key) {
        const acts = {m: () => this.targets.chosen !== null && this.targets.move(this.targets.chosen,
            this.map.centerPlace),
            Delete: () => this.targets.remove(),
                Escape: () => { document.querySelector('input[name="tool"][value="look"]').checked = true; }};
        acts[key]?.();
        return key in acts;
    }

    draw(ms) {
        requestAnimationFrame((next) => this.draw(next));
        const isCalm = matchMedia('(prefers-reduced-motion: reduce)').matches;
        const isDue = ms - (this.drawnMs ?? -Infinity) > (isCalm ? DRAW_MS.calm : DRAW_MS.usual);
        const isHandled = this.map.pointers.size > 0 || document.activeElement === this.map.canvas;
        if (!this.isDirty || !(isDue || isHandled)) {
            return;
        }
        this.drawnMs = ms;
        this.isDirty = false;
        this.followOwn(isCalm);
        this.map.draw(this.layers);
    }

    /* Keep own aircraft on the map: in its middle, or, where motion is not wanted, by steps. */
    followOwn(isCalm) {
        const own = this.world.ownAircraft(), {map} = this;
        find('map-follow').checked = map.isFollowing;
        if (!own || !map.isFollowing) {
            return;
        }
        const [x, y] = map.toPixel(own), {clientWidth: width, clientHeight: height} = map.canvas;
        const isNearEdge = x < 0.2 * width || x > 0.8 * width || y < 0.2 * height || y > 0.8 * height;
        if (!isCalm || isNearEdge) {
            map.goTo(own);
            this.isDirty = false;
        }
    }

    /* ---- tabs ---- */

    makeTabs() {
        const tabs = [...document.querySelectorAll('[role="tab"]')];
        const show = (tab) => tabs.forEach((t) => {
            const is = t === tab;
            t.setAttribute('aria-selected', String(is));
            t.tabIndex = is ? 0 : -1;
            find(t.getAttribute('aria-controls')).hidden = !is;
        });
        tabs.forEach((tab, at) => {
            tab.addEventListener('click', () => show(tab));
            tab.addEventListener('keydown', (event) => {
                const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
                const to = step ? tabs[(at + step + tabs.length) % tabs.length]
                    : {Home: tabs[0], End: tabs.at(-1)}[event.key];
                if (to) {
                    event.preventDefault();
                    show(to);
                    to.focus();
                }
            });
        });
        show(tabs[0]);
    }
}

const station = new Station();
globalThis.station = station; // for tests, and for whoever opens the browser's console
station.start().catch((error) => {
    say(find('connection'), 'NOT STARTED');
    say(find('lost'), error.message);
});

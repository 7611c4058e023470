/* The panel of live targets: place, change, give ways, remove; and all of them in words. */
import {button, find, limits, make, numberOf, rows, say} from './dom.mjs';
import {KINDS, SPEED_MOST} from './frames.mjs';
import {between, NAUTICAL_MILE_M} from './geo.mjs';

/* Fields of the form: id, name in a target, whether empty is an answer. */
const NUMBERS = [['target-speed', 'speedMs', false], ['target-course', 'courseDeg', false],
    ['target-height', 'heightM', true],
    ['target-rcs', 'rcsDbsm', true], ['target-signature', 'signature', false]];

export class TargetsPanel {
    /* `station`: {world, commands, keeper, map, report(text), changed()}. */
    constructor(station) {
        Object.assign(this, {station, chosen: null, filledFor: null});
        KINDS.forEach((name, kind) => find('target-kind').append(make('option',
            {value: kind, text: `${kind} ${name}`})));
        find('target-kind').value = 2;
        find('target-speed').max = SPEED_MOST;
        const acts = {'target-place': () => this.place(station.map.centerPlace), 'target-apply': () => this.apply(),
            'target-move': () => this.move(this.chosen, station.map.centerPlace),
                'target-waypoint': () => this.waypoint(station.map.centerPlace),
            'target-route-clear': () => this.change({route: []}), 'target-remove': () => this.remove(),
            'target-remove-all': () => station.commands.removeAllTargets()};
        Object.entries(acts).forEach(([id, act]) => find(id).addEventListener('click', act));
        find('target-loop').addEventListener('change', () => this.change({isLoop: find('target-loop').checked}));
    }

    /* What the form says, or null, with a word, where it says what cannot be. */
    form() {
        const values = {kind: Number(find('target-kind').value)};
        for (const [id, name, mayBeEmpty] of NUMBERS) {
            const value = numberOf(find(id));
            if (Number.isNaN(value)) {
                this.station.report(limits(find(id)));
                find(id).focus();
                return null;
            }
            values[name] = value === null && !mayBeEmpty ? 0 : value;
        }
        return values;
    }

    place(place) {
        const values = this.form();
        if (values) {
            const number = this.station.commands.placeTarget({...values, ...place});
            if (number === null) {
                this.station.report('all 256 numbers of live targets are in use');
            } else {
                this.choose(number);
            }
        }
    }

    apply() {
        const values = this.form();
        if (values) {
            this.change(values);
        }
    }

    change(values) {
        if (this.chosen === null || !this.station.commands.changeTarget(this.chosen, values)) {
            this.station.report('choose a target first: on the map, or in the list');
        }
    }

    move(number, {latitude, longitude}) {
        this.choose(number);
        this.change({latitude, longitude});
    }

    waypoint({latitude, longitude}) {
        if (this.chosen === null || !this.station.commands.addWaypoint(this.chosen, {latitude, longitude})) {
            this.station.report('choose the target that shall go there first');
        }
    }

    remove() {
        if (this.chosen !== null) {
            this.station.commands.removeTarget(this.chosen);
        }
    }

    choose(number) {
        this.chosen = number;
        this.filledFor = null;
        this.station.changed();
    }

    routeOf(number) {
        return this.station.keeper.kept.get(`target ${number}`)?.target?.route ?? [];
    }

    /* Once after a target was chosen and heard, the form shows what it is. */
    fill() {
        const {world} = this.station, told = world.targets.get(this.chosen);
        if (!told || this.filledFor === this.chosen) {
            return;
        }
        this.filledFor = this.chosen;
        find('target-kind').value = told.kind;
        const words = {speedMs: told.speedMs.toFixed(0), courseDeg: ((told.courseDeg + 360) % 360).toFixed(0),
            heightM: told.heightM?.toFixed(0) ?? '',
            rcsDbsm: told.rcsDbsm?.toFixed(0) ?? '', signature: String(told.signature)};
        NUMBERS.forEach(([id, name]) => { find(id).value = words[name]; });
        find('target-loop').checked = this.station.keeper.kept.get(`target ${this.chosen}`)?.target?.isLoop ?? false;
    }

    render() {
        const {world} = this.station, own = world.ownAircraft();
        if (this.chosen !== null && this.filledFor === this.chosen && !world.targets.has(this.chosen)) {
            this.chosen = this.filledFor = null;
        }
        this.fill();
        say(find('target-chosen'), this.chosen === null ? 'No target chosen' : `Target ${this.chosen}`);
        ['target-apply', 'target-move', 'target-waypoint', 'target-route-clear', 'target-remove'].forEach((id) => {
            find(id).disabled = this.chosen === null;
        });
        const items = [...world.targets.values()].sort((a, b) => a.number - b.number).slice(0,
            256).map((t) => ({...t, key: t.number}));
        rows(find('target-list'), items, (t) => this.makeRow(t.number), (row, t) => this.fillRow(row, t, own));
        say(find('target-count'), items.length === 0 ? 'No live targets.'
            : `${items.length} live target${items.length === 1 ? '' : 's'}`);
    }

    makeRow(number) {
        const choose = button(String(number), () => this.choose(this.chosen === number ? null : number),
            {'aria-label': `choose target ${number}`});
        return make('tr', {}, make('td', {}, choose), ...['kind', 'motion', 'where',
            'by'].map((name) => make('td', {class: name})));
    }

    fillRow(row, t, own) {
        const at = this.station.world.reckoned(t), route = this.routeOf(t.number);
        const seen = own ? between(own, at) : null, [choose] = row.getElementsByTagName('button');
        choose.setAttribute('aria-pressed', String(this.chosen === t.number));
        say(row.querySelector('.kind'), KINDS[t.kind]);
        const motion = t.speedMs > 0 ? `${t.speedMs.toFixed(0)} m/s ${((t.courseDeg + 360) % 360).toFixed(0)}°` : 'stands';
        const height = t.heightM === null ? '' : `, ${t.heightM.toFixed(0)} m high`;
        say(row.querySelector('.motion'), `${motion}${height}${route.length ? `, ${route.length} waypoints` : ''}`);
        say(row.querySelector('.where'),
            seen ? `${seen.bearingDeg.toFixed(0)}° ${(seen.distanceM / NAUTICAL_MILE_M).toFixed(1)} NM` : '');
        say(row.querySelector('.by'), this.station.toldBy(`target ${t.number}`, t));
    }
}

/* The displays: what each says of itself, its repeater, and the controls of those that obey. */
import {find, limits, make, rows, say} from './dom.mjs';
import {controlFrames, FIELDS_OF_VIEW, FLAG_WORDS, MODES, PAGES} from './frames.mjs';
import {hold, makeBezel} from './web/bezel.mjs';

const SLEW = 1000, SILENT_US = 3e6;
const SWITCH_OF = {'control-designate': 1, 'control-drop': 2, 'control-freeze': 3, 'control-release': 4};

export class DisplaysPanel {
    constructor(station, listed) {
        Object.assign(this, {station, listed, deflection: [0, 0]});
        const {commands} = station;
        this.hands = makeBezel(find('bezel'), (isDown, number) => commands.control(controlFrames.key(isDown, number)));
        Object.entries(SWITCH_OF).forEach(([id, act]) => find(id).addEventListener('click',
            () => commands.control(controlFrames.switch(act))));
        document.querySelectorAll('[data-slew]').forEach((b) => {
            const [x, y] = b.dataset.slew.split(',').map(Number);
            hold(b, () => this.slew(x, y), () => this.slew(-x, -y));
        });
        const acts = {'control-sector': () => commands.control(controlFrames.sector(Number(find('control-mode').value),
            Number(find('control-field').value))),
            'control-range': () => commands.control(controlFrames.rangeScale(Number(find('control-nm').value))),
            'control-width': () =>
                commands.control(controlFrames.sectorWidth(Number(find('control-width-number').value))),
            'control-gain': () => this.number('control-db', -30, 30, (db) => controlFrames.gain(db)),
            'control-steer-off': () => commands.control(controlFrames.steerOff()),
            'control-cursor-here': () => this.at('cursor', station.map.centerPlace),
                'control-steer-here': () => this.at('steer', station.map.centerPlace),
            'control-patch-here': () => this.at('patch', station.map.centerPlace)};
        Object.entries(acts).forEach(([id, act]) => find(id).addEventListener('click', act));
        find('control-knob').addEventListener('change', () =>
            commands.control(controlFrames.knob(Number(find('control-knob').value))));
        addEventListener('pagehide', () => this.letGo());
    }

    number(id, low, high, make) {
        const value = Number(find(id).value);
        if (find(id).value === '' || !(value >= low && value <= high)) {
            this.station.report(limits(find(id)));
        } else {
            this.station.commands.control(make(Math.round(value)));
        }
    }

    slew(x, y) {
        this.deflection = [this.deflection[0] + x, this.deflection[1] + y];
        this.station.commands.control(controlFrames.slew(...this.deflection.map((d) => SLEW * Math.sign(d))));
    }

    /* A hand that goes away with the page holds nothing. */
    letGo() {
        this.hands.forEach((hand) => hand.up());
        if (this.deflection.some((d) => d !== 0)) {
            this.station.commands.control(controlFrames.slew(0, 0));
        }
    }

    /* Cursor, steerpoint or patch at a place. */
    at(what, {latitude, longitude}) {
        this.station.commands.control(what === 'patch' ? controlFrames.patch(latitude, longitude,
            Number(find('control-cell').value))
            : controlFrames[what](latitude, longitude));
    }

    render() {
        const {world} = this.station, named = this.listed.map((d) => ({...d, key: d.name}));
        const others = [...world.displays.keys()].filter((node) => !this.listed.some((d) => d.node === node));
        const items = [...named, ...others.map((node) => ({name: `node ${node}`, node, recording: null,
            key: `node ${node}`}))];
        rows(find('display-list'), items, (d) => this.makeRow(d),
            (row, d) => say(row.querySelector('.state'), this.words(world.displays.get(d.node))));
        say(find('display-none'),
            items.length === 0 ? 'No display has said anything yet: it needs a node number and reports.' : '');
    }

    makeRow({name, recording}) {
        const link = recording ? [make('a', {href: `repeater.html?display=${encodeURIComponent(name)}`, target: '_blank',
            rel: 'noopener', text: 'Repeater'})] : [];
        return make('li', {}, make('strong', {text: `${name} `}), make('span', {class: 'state'}), ' ', ...link);
    }

    words(display) {
        if (!display) {
            return 'not heard';
        }
        const {picture, range, settings, flags, timeUs} = display, ageUs = this.station.world.nowUs - timeUs;
        const shown = picture ? (picture.kind === 1 ? 'patch'
            : `${MODES[picture.mode] ?? '?'} ${FIELDS_OF_VIEW[picture.field] ?? '?'}`) : '';
        const warnings = FLAG_WORDS.filter((_, n) => flags >>> n & 1);
        return [ageUs > SILENT_US ? `SILENT for ${(ageUs / 1e6).toFixed(0)} s` : '',
            `page ${PAGES[picture?.page] ?? 'unknown'}`, shown,
            range ? `${range.nm} NM` : '', settings ? `±${settings.halfSectorDeg}°` : '',
                warnings.length ? `says ${warnings.join(', ')}` : 'no warning']
            .filter((words) => words !== '').join('; ');
    }
}

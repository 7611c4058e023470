/* The panel of weather: four circles of rain, four jammers, the sea and its wind. */
import {button, find, limits, make, numberOf, rows, say} from './dom.mjs';
import {placeWords} from './geo.mjs';

const FORMS = {rain: [['rain-radius', 'radiusM', 1000], ['rain-rate', 'rateMmH', 1]],
    jammer: [['jammer-ratio', 'ratioDb', 1]]};

export class WeatherPanel {
    constructor(station) {
        this.station = station;
        for (const what of ['rain', 'jammer']) {
            find(`${what}-place`).addEventListener('click', () => this.place(what, station.map.centerPlace));
        }
        find('sea-tell').addEventListener('click', () => station.commands.sea(Number(find('sea-state').value)));
        find('wind-tell').addEventListener('click', () => this.wind());
        find('weather-clear').addEventListener('click', () => station.commands.fairWeather());
    }

    /* What the form of rain or of a jammer says, or null. */
    form(what) {
        const values = {};
        for (const [id, name, unit] of FORMS[what]) {
            const value = numberOf(find(id));
            if (value === null || Number.isNaN(value)) {
                this.station.report(limits(find(id)));
                find(id).focus();
                return null;
            }
            values[name] = value * unit;
        }
        return values;
    }

    place(what, {latitude, longitude}, number = null) {
        const values = this.form(what);
        if (values && this.station.commands.circle(what, number, {...values, latitude, longitude}) === null) {
            this.station.report(`all four of ${what} are in use: remove one first`);
        }
    }

    move(what, number, {latitude, longitude}) {
        this.station.commands.circle(what, number, {...this.station.world[what].get(number), latitude, longitude});
    }

    wind() {
        const fromDeg = numberOf(find('wind-from'));
        if (fromDeg === null || Number.isNaN(fromDeg)) {
            this.station.report('wind: 0 to 360 degrees, from which it comes');
        } else {
            this.station.commands.wind(fromDeg);
        }
    }

    render() {
        const {world} = this.station;
        for (const what of ['rain', 'jammer']) {
            const items = [...world[what].values()].sort((a, b) => a.number - b.number).map((c) =>
                ({...c, key: c.number}));
            rows(find(`${what}-list`), items, (c) => this.makeRow(what, c.number),
                (row, c) => this.fillRow(row, what, c));
        }
        const told = (thing, words, key) => thing ? `${words(thing.value)}, told by ${this.station.toldBy(key, thing)}`
            : 'as in the image';
        say(find('sea-told'), told(world.sea, (state) => `state ${state}`, 'sea'));
        say(find('wind-told'), world.wind ? told(world.wind, (deg) => `from ${deg.toFixed(0)}°`, 'wind') : 'not told');
    }

    makeRow(what, number) {
        const {commands, world, map} = this.station;
        const values = () => this.form(what), held = () => world[what].get(number);
        return make('li', {}, make('span', {class: 'words'}),
            button('Change', () => values() && held() && commands.circle(what, number, {...held(), ...values()}),
                {'aria-label': `change ${what} ${number} to the numbers above`}),
            button('Move', () => held() && this.move(what, number, map.centerPlace),
                {'aria-label': `move ${what} ${number} to the middle of the map`}),
            button('Remove', () => commands.removeCircle(what, number), {'aria-label': `remove ${what} ${number}`}));
    }

    fillRow(row, what, circle) {
        const words = what === 'rain' ? `${circle.rateMmH.toFixed(0)} mm/h, ${(circle.radiusM / 1000).toFixed(1)} km`
            : `${circle.ratioDb.toFixed(0)} dB`;
        const by = this.station.toldBy(`${what} ${circle.number}`, circle);
        say(row.querySelector('.words'), `${circle.number}: ${words} at ${placeWords(circle)}, ${by} `);
    }
}

/* The panel of malfunctions: the ten kinds, each broken and mended by itself. Whatever is told of them, buttons stay
 * where they are: who presses one must not meet another. */
import {button, find, make, numberOf, say} from './dom.mjs';
import {MALFUNCTIONS} from './frames.mjs';

export class MalfunctionsPanel {
    constructor(station) {
        this.station = station;
        this.rows = MALFUNCTIONS.map((of, kind) => this.makeRow(of, kind));
        find('malfunction-list').append(...this.rows);
        find('mend-all').addEventListener('click', () => station.commands.mendAll());
    }

    makeRow({name, unit, low, high, usual}, kind) {
        const id = `malfunction-${kind}`, {commands} = this.station;
        const amount = make('input', {type: 'number', id, min: low, max: high, value: usual,
            step: unit === 'key' ? 1 : 'any', 'aria-label': `${name}, ${unit}`});
        const act = () => {
            const value = unit ? numberOf(amount) : 0;
            if (value === null || Number.isNaN(value)) {
                this.station.report(`${name}: ${low} to ${high} ${unit}`);
                amount.focus();
            } else {
                commands.malfunction(kind, value);
            }
        };
        const cell = make('td', {}, ...unit ? [amount, ` ${unit}`] : []);
        const head = make('th', {scope: 'row'}, make('span', {text: name}), make('span', {class: 'told'}));
        return make('tr', {}, head, cell,
            make('td', {}, button('Break', act, {class: 'break', 'aria-label': `break: ${name}`}), ' ',
                button('Mend', () => commands.mend(kind), {class: 'mend', 'aria-label': `mend: ${name}`})));
    }

    render() {
        this.rows.forEach((row, kind) => {
            const told = this.station.world.malfunctions.get(kind), {unit} = MALFUNCTIONS[kind];
            row.classList.toggle('is-broken', Boolean(told));
            row.querySelector('.break').setAttribute('aria-pressed', String(Boolean(told)));
            row.querySelector('.mend').disabled = !told;
            const amount = told && unit ? ` ${Number(told.amount.toFixed(1))} ${unit}` : '';
            const words = told ? `broken${amount}: ${this.station.toldBy(`malfunction ${kind}`, told)}` : 'works';
            say(row.querySelector('.told'), words);
        });
    }
}

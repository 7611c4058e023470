/* The exercise clock: freeze, run, jump, rate and seed. */
import {find, numberOf, say} from './dom.mjs';
import {clockOf, clockWords} from './geo.mjs';

const SEED_MOST = 2147483647;

export class ClockPanel {
    constructor(station) {
        this.station = station;
        const {commands, world} = station;
        const acts = {freeze: () => commands.clock({rate: 0}), run: () => commands.clock({rate: this.runRate()}),
            'clock-jump': () => this.jump(),
            'clock-rate-tell': () => commands.clock({rate: Number(find('clock-rate').value)}),
                'clock-seed-tell': () => this.seed()};
        Object.entries(acts).forEach(([id, act]) => find(id).addEventListener('click', act));
        document.querySelectorAll('[data-by]').forEach((b) => b.addEventListener('click', () =>
            commands.clock({timeMs: Math.max((world.exerciseMs() ?? 0) + 1000 * Number(b.dataset.by), 0)})));
    }

    /* The rate that the list says; a frozen exercise runs again with it. */
    runRate() {
        return Number(find('clock-rate').value) || 1;
    }

    jump() {
        const timeMs = clockOf(find('clock-time').value);
        if (timeMs === null) {
            this.station.report('exercise clock: write hours:minutes:seconds, as 1:02:30');
            find('clock-time').focus();
        } else {
            this.station.commands.clock({timeMs});
        }
    }

    seed() {
        const seed = numberOf(find('clock-seed'));
        if (seed === null || !(seed >= 0 && seed <= SEED_MOST)) {
            this.station.report(`seed: 0 to ${SEED_MOST}`);
        } else {
            this.station.commands.clock({seed});
        }
    }

    render() {
        const {world} = this.station, {clock} = world, ms = world.exerciseMs();
        say(find('exercise-clock'), ms === null ? '-:--:--' : clockWords(ms));
        const isFrozen = clock?.rate === 0, isStale = clock !== null && world.isStale(clock);
        say(find('exercise-state'), ms === null ? 'no exercise clock told'
            : `${isFrozen ? 'FROZEN' : `runs, rate ${clock.rate}`}${isStale ? ', NOT TOLD ANY MORE' : ''}`);
        find('freeze').setAttribute('aria-pressed', String(isFrozen));
        find('run').setAttribute('aria-pressed', String(clock !== null && !isFrozen));
        say(find('clock-told'),
            clock === null ? 'Nobody tells a clock: the displays count from when they were switched on.'
            : `Rate ${clock.rate}, seed ${clock.seed ?? 'of the displays'}, told by `
                + `${this.station.toldBy('clock', clock)}.`);
    }
}

/* What an instructor can do: each command is frames of docs/bus.md, sent at once and, where the bus
 * wants it, kept: told again once a second. Nothing is shown because it was asked for; what is shown is
 * what comes back. */
import * as F from './frames.mjs';
import {Target} from './targets.mjs';

const CIRCLE_NUMBERS = [0, 1, 2, 3];

export class Commands {
    constructor(world, keeper) {
        Object.assign(this, {world, keeper, lastUs: null, lastMs: null});
    }

    /* ---- live targets ---- */

    /* Place a target; its number, or null where all are in use. */
    placeTarget(of) {
        const isFree = (n) => !this.world.targets.has(n) && !this.keeper.kept.has(`target ${n}`);
        const number = Array.from({length: F.TARGETS}, (_, n) => n).find(isFree) ?? null;
        if (number !== null) {
            this.keepTarget(new Target({...of, number}));
        }
        return number;
    }

    keepTarget(target) {
        this.keeper.keep(`target ${target.number}`, () => F.targetFrames(target.number, target), {target});
    }

    /* The target as this page moves it; one that is not its own it takes over as the bus has it. */
    targetOf(number) {
        const kept = this.keeper.kept.get(`target ${number}`), told = this.world.targets.get(number);
        if (kept || !told) {
            return kept ? kept.target : null;
        }
        const {latitude, longitude} = this.world.reckoned(told),
            {kind, speedMs, courseDeg, heightM, rcsDbsm, signature} = told;
        return new Target({number, latitude, longitude, kind, speedMs, courseDeg, heightM, rcsDbsm, signature});
    }

    /* Change some of what a target is; false where there is none. */
    changeTarget(number, change) {
        const before = this.targetOf(number);
        if (before) {
            this.keepTarget(new Target({...before, ...change}));
        }
        return before !== null;
    }

    addWaypoint(number, {latitude, longitude}) {
        const target = this.targetOf(number);
        return target !== null && this.changeTarget(number, {route: [...target.route, {latitude, longitude}]});
    }

    removeTarget(number) {
        this.keeper.remove([`target ${number}`], F.removeTargetFrames(number));
    }

    removeAllTargets() {
        const keys = [...this.world.targets.keys()].map((n) => `target ${n}`);
        this.keeper.remove([...new Set([...keys, ...this.keeper.keys.filter((key) => key.startsWith('target'))])],
            F.clearTargetsFrames());
    }

    /* ---- weather ---- */

    /* Rain or a jammer of a number; null: the next free one. The number, or null where all are in use. */
    circle(what, number, values) {
        const free = number ?? CIRCLE_NUMBERS.find((n) => !this.world[what].has(n)
            && !this.keeper.kept.has(`${what} ${n}`)) ?? null;
        if (free !== null) {
            const make = what === 'rain' ? F.rainFrames : F.jammerFrames;
            this.keeper.keep(`${what} ${free}`, () => make(free, values));
        }
        return free;
    }

    removeCircle(what, number) {
        this.keeper.remove([`${what} ${number}`], F.clearWeatherFrames(1 << (what === 'rain' ? number : 4 + number)));
    }

    sea(state) {
        this.keeper.keep('sea', () => F.seaFrames(state));
    }

    wind(fromDeg) {
        this.keeper.keep('wind', () => F.windFrames(fromDeg));
    }

    fairWeather() {
        const numbered = (name) => CIRCLE_NUMBERS.map((n) => `${name} ${n}`);
        this.keeper.remove([...numbered('rain'), ...numbered('jammer'), 'sea', 'wind'], F.clearWeatherFrames(F.ALL));
    }

    /* ---- malfunctions ---- */

    malfunction(kind, amount) {
        this.keeper.keep(`malfunction ${kind}`, () => F.malfunctionFrames(kind, amount));
    }

    mend(kind) {
        this.keeper.remove([`malfunction ${kind}`], F.clearMalfunctionFrames(kind));
    }

    mendAll() {
        this.keeper.remove(F.MALFUNCTIONS.map((_, kind) => `malfunction ${kind}`), F.clearMalfunctionFrames(F.ALL));
    }

    /* ---- exercise clock ---- */

    /* The clock from now on. What is left out stays as it is told. Where nobody told one, it begins at 0, runs, and
     * has no seed. */
    clock({timeMs = this.world.exerciseMs() ?? 0, rate = this.world.clock?.rate ?? 1,
        seed = this.world.clock?.seed ?? null}) {
        const beganMs = this.keeper.nowMs();
        const nowMs = () => Math.round(timeMs + rate * (this.keeper.nowMs() - beganMs));
        const frames = () => F.clockFrames({timeMs: nowMs(), rate, seed});
        this.keeper.keep('clock', frames);
        this.refreshTargets();
    }

    /* A set holds at the exercise's time when it came: after a step of the clock they are told anew. */
    refreshTargets() {
        this.keeper.kept.forEach((item, key) => item.target && this.keeper.refresh(key));
    }

    /* ---- controls of the displays that obey ---- */

    control(frames) {
        this.keeper.tell(frames);
    }

    /* ---- time goes on ---- */

    /* Move this page's targets by the exercise's time, repeat what is due, and keep what nobody keeps any more. */
    tick() {
        const {world, keeper} = this, exerciseMs = world.exerciseMs(), nowMs = keeper.nowMs();
        const clock = exerciseMs === null ? nowMs : exerciseMs, isSame = this.isExercise === (exerciseMs !== null);
        const seconds = this.lastMs === null || !isSame ? 0 : (clock - this.lastMs) / 1000;
        Object.assign(this, {lastMs: clock, isExercise: exerciseMs !== null});
        keeper.kept.forEach((item, key) => {
            if (item.target?.advance(seconds)) {
                keeper.refresh(key);
            }
        });
        keeper.tick();
        keeper.orphans(this.things(), world.nowUs).forEach(({key}) => this.adopt(key));
    }

    /* Everything that somebody has to repeat. */
    things() {
        const {world} = this, list = [];
        const add = (name, held) => held.forEach((thing, n) => list.push({...thing, key: `${name} ${n}`}));
        add('target', world.targets);
        add('rain', world.rain);
        add('jammer', world.jammer);
        add('malfunction', world.malfunctions);
        ['sea', 'wind', 'clock'].forEach((key) => world[key] && list.push({...world[key], key}));
        return list;
    }

    adopt(key) {
        const [name, word] = key.split(' '), number = Number(word), {world} = this;
        const acts = {target: () => this.changeTarget(number, {}),
            rain: () => this.circle('rain', number, world.rain.get(number)),
            jammer: () => this.circle('jammer', number, world.jammer.get(number)), sea: () => this.sea(world.sea.value),
            wind: () => this.wind(world.wind.value), clock: () => this.clock({}),
            malfunction: () => this.malfunction(number, world.malfunctions.get(number).amount)};
        acts[name]();
    }
}

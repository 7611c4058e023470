/* What a step of the display costs as a module of WebAssembly, in node: each mode flown over the
 * built-in scene, or over another image.
 *
 *     node tests/bench/web.mjs IMAGE [MODULE...]      modules take turns: one figure beside the other
 *
 * Prints for each mode and module the median of a step, the 99th of a hundred, and the processor's time
 * for a second of flight, JavaScript included: of ROUNDS rounds the least, which others disturbed
 * least. */
import fs from 'node:fs';

import {Flight} from '../../bsp/web/page/flight.mjs';
import {Unit} from '../../bsp/web/page/unit.mjs';

const SIDE = 768, STEP_US = 4000, WARM_S = 4, SECONDS = 12, ROUNDS = 5;
const START = {latitude: 42.045, longitude: -29.18, headingDeg: 90, heightM: 3000, speedMs: 180};
const TOWN = [41.9949518, -29.0079712];
const press = (unit, ...keys) => keys.flatMap((key) => [[true, key], [false, key]]).map((act) => () => unit.calls.button(...act));

/* One after the other, every four seconds. */
const patches = (unit, cellM) => Array.from({length: 200}, (_, n) => () => n % 40 === 0 && unit.patch(...TOWN, cellM));

/* What brings a display that was just started into a mode, an act a tenth of a second. */
const MODES = {
    'GM': () => [],
    'GMT': (unit) => press(unit, 1),
    'SEA': (unit) => press(unit, 1, 1),
    'GM EXP': (unit) => press(unit, 3),
    'GM DBS2': (unit) => press(unit, 3, 3, 3),
    'patches of 2 m': (unit) => patches(unit, 2),
    'patches of 1 m': (unit) => patches(unit, 1),
};

async function fly(moduleBytes, image, acts) {
    const source = {name: 'image', size: image.length, read: async (at, length) => image.subarray(at, at + length)};
    const unit = await Unit.load(moduleBytes, source), bus = new Flight(START), took = [];
    await unit.open(SIDE, SIDE);
    const list = acts(unit);
    let warm = null;
    for (let us = STEP_US, n = 0; us <= (WARM_S + SECONDS) * 1e6; us += STEP_US, n++) {
        bus.deliver(unit, us);
        if (n % 25 === 0) {
            list.shift()?.();
        }
        const begunMs = performance.now();
        unit.step(us);
        if (us > WARM_S * 1e6) {
            warm ??= process.cpuUsage();
            took.push(performance.now() - begunMs);
        }
        await unit.flash.settled();
    }
    const {user, system} = process.cpuUsage(warm);
    took.sort((a, b) => a - b);
    const at = (part) => took[Math.floor(part * (took.length - 1))];
    return {words: unit.describe().split(';')[0], median: at(0.5), most: at(0.99), share: (user + system) / 1000 / SECONDS};
}

/* All rounds of all modules: they take turns, so that a busy minute meets each of them. */
async function main([imagePath, ...modulePaths]) {
    const image = fs.readFileSync(imagePath), paths = modulePaths.length ? modulePaths : ['build/web/landmass.wasm'];
    const modules = paths.map((path) => fs.readFileSync(path));
    console.log(`${'mode'.padEnd(16)} ${'module'.padEnd(28)}  median ms    99 % ms  ms of processor for 1 s`);
    for (const [mode, acts] of Object.entries(MODES)) {
        const rounds = paths.map(() => []);
        for (let round = 0; round < ROUNDS; round++) {
            for (const [n, module] of modules.entries()) {
                rounds[n].push(await fly(module, image, acts));
            }
        }
        paths.forEach((path, n) => {
            const least = (key) => Math.min(...rounds[n].map((one) => one[key]));
            console.log(`${mode.padEnd(16)} ${path.slice(-28).padEnd(28)} ${['median', 'most', 'share'].map((key) =>
                least(key).toFixed(3).padStart(10)).join(' ')}  ${rounds[n][0].words}`);
        });
    }
}

if (process.argv.length < 3) {
    console.error('Usage: node tests/bench/web.mjs IMAGE [MODULE...]');
    process.exit(2);
}
await main(process.argv.slice(2));

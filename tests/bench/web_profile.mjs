/* Where a module of WebAssembly spends its time: sums a profile of node by function.
 *
 *     make BOARD=web O=build/named STRIP_wasm= all
 *     node --cpu-prof --cpu-prof-dir=build/prof tests/bench/web.mjs IMAGE build/named/landmass.wasm
 *     node tests/bench/web_profile.mjs build/prof/*.cpuprofile
 *
 * Prints each function's own share of the module's time, and what the kernels, lm_k_..., take together. */
import fs from 'node:fs';

const LEAST = 0.005;

/* Microseconds that each function of the module was at the top of the stack. */
function timesOf({nodes, samples, timeDeltas}) {
    const names = new Map(nodes.filter(({callFrame}) => callFrame.url.startsWith('wasm:'))
        .map(({id, callFrame}) => [id, callFrame.functionName])), times = new Map();
    samples.forEach((id, n) => {
        const name = names.get(id);
        if (name !== undefined) {
            times.set(name, (times.get(name) ?? 0) + timeDeltas[n]);
        }
    });
    return times;
}

const all = new Map();
for (const path of process.argv.slice(2)) {
    timesOf(JSON.parse(fs.readFileSync(path, 'utf8'))).forEach((us, name) => all.set(name, (all.get(name) ?? 0) + us));
}
const total = [...all.values()].reduce((sum, us) => sum + us, 0);
if (total === 0) {
    console.error('Usage: node tests/bench/web_profile.mjs PROFILE...: none of them has a function of a module of WebAssembly');
    process.exit(2);
}
const share = (us) => `${(100 * us / total).toFixed(1).padStart(5)} %`;
for (const [name, us] of [...all].sort((a, b) => b[1] - a[1])) {
    if (us >= LEAST * total) {
        console.log(`${share(us)}  ${name}`);
    }
}
const kernels = [...all].filter(([name]) => name.startsWith('lm_k_')).reduce((sum, [, us]) => sum + us, 0);
console.log(`${share(kernels)}  all kernels, of ${(total / 1e6).toFixed(1)} s in the module`);

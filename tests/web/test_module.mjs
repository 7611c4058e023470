/* The module in node: its golden pictures are those of the PC, and a flight shows what landmass-sim
 * shows. Usage: node test_module.mjs, in the project's folder; BUILD names the PC's build. */
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import {test} from 'node:test';

import {drawGoldens} from './goldens.mjs';

const build = process.env.BUILD ?? 'build/bench-linux', tmp = `${build}/tmp/web`;
fs.mkdirSync(tmp, {recursive: true});

test('a module of WebAssembly draws the golden pictures, bit for bit', async () => {
    const flash = `${tmp}/golden.flash`;
    execFileSync(`${build}/bin/tests/zcu102/golden_flash`, [flash]);
    const drawn = await drawGoldens(fs.readFileSync('build/web/golden.wasm'), fs.readFileSync(flash).buffer);
    assert.equal(drawn.join('\n') + '\n', fs.readFileSync('tests/golden/pictures.golden', 'utf8'));
});

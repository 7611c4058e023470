/* The golden pictures in a browser: the lines, or what went wrong, into the page. */
import {drawGoldens} from './goldens.mjs';

const bytes = async (name) => (await fetch(name)).arrayBuffer();
drawGoldens(await bytes('golden.wasm'), await bytes('golden.flash'))
    .then((lines) => lines.join('\n') + '\n', (error) => `failed: ${error.message}`)
    .then((text) => { document.getElementById('lines').textContent = text; });

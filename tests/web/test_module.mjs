/* The module in node: what it draws is what the PC draws, its flash is as late and as faulty as any,
 * and what a flight by hand sends is understood. Usage: node test_module.mjs, in the project's
 * folder; BUILD names the PC's build. */
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import {test} from 'node:test';

import {LogBus, parseLine, SocketBus} from '../../bsp/web/page/bus.mjs';
import {BLOCK, httpSource} from '../../bsp/web/page/flash.mjs';
import {Flight} from '../../bsp/web/page/flight.mjs';
import {buttonOf} from '../../bsp/web/page/keyboard.mjs';
import {Unit} from '../../bsp/web/page/unit.mjs';
import {serve} from '../../bsp/web/serve.mjs';
import {drawGoldens, placesOf} from './goldens.mjs';

const build = process.env.BUILD ?? 'build/bench-linux', tmp = `${build}/tmp/web`;
const program = (name, ...words) => execFileSync(`${build}/bin/${name}`, words, {encoding: 'utf8'});
const SIDE = 768, FLAG_NAV_DEAD = 1 << 1;

fs.mkdirSync(tmp, {recursive: true});
program('tests/zcu102/golden_flash', `${tmp}/golden.flash`);
const goldens = new Uint8Array(fs.readFileSync(`${tmp}/golden.flash`)).buffer;
const middle = placesOf(goldens)[0]; // 46 N 11 E
const image = new Uint8Array(goldens, middle.offset, middle.size);
fs.writeFileSync(`${tmp}/middle.lmdb`, image);
const moduleBytes = fs.readFileSync('build/web/landmass.wasm');

/* A source in memory. `read` may be replaced. */
const memorySource = () => ({name: 'memory', size: image.length,
    read: async (offset, length) => image.slice(offset, offset + length)});

async function openUnit(source = memorySource()) {
    const unit = await Unit.load(moduleBytes, source);
    await unit.open(SIDE, SIDE);
    return unit;
}

/* Step to a time; reads that are under way arrive between two steps. */
async function fly(unit, bus, fromUs, toUs, each = () => {}) {
    for (let now = fromUs; now <= toUs; now += 2000) {
        bus.deliver(unit, now);
        unit.step(now);
        each(now);
        await unit.flash.settled();
    }
}

test('golden pictures are those of the PC, bit for bit', async () => {
    const drawn = await drawGoldens(fs.readFileSync('build/web/golden.wasm'), goldens);
    assert.equal(drawn.join('\n') + '\n', fs.readFileSync('tests/golden/pictures.golden', 'utf8'));
});

/* CRC-32C of pixels as picture_checksum has it: each as four bytes, blue first. */
function checksum(rgba) {
    let crc = ~0;
    for (let at = 0; at < rgba.length; at += 4) {
        for (const byte of [rgba[at + 2], rgba[at + 1], rgba[at], 0]) {
            crc ^= byte;
            for (let bit = 0; bit < 8; bit++) {
                crc = crc >>> 1 ^ (crc & 1 ? 0x82f63b78 : 0);
            }
        }
    }
    return (~crc >>> 0).toString(16).padStart(8, '0');
}

test('a flight shows what landmass-sim shows, pixel for pixel', async () => {
    program('landmass-nav', '--straight', '45.95,11,0,3000,180', '--seconds', '8', '--out', `${tmp}/flight.log`);
    fs.writeFileSync(`${tmp}/script`, '6 picture shown\n');
    program('landmass-sim', '--db', `${tmp}/middle.lmdb`, '--bus', `${tmp}/flight.log`, '--script', `${tmp}/script`,
        '--png', tmp, '--every', '0', '--seconds', '7');
    const shown = program('tests/zcu102/picture_checksum', `${tmp}/shown.png`).trim().split(' ').at(-1);
    const unit = await openUnit(), pictures = [];
    for (let n = 0; n * BLOCK < image.length; n++) { // no read is late, as from a file
        unit.flash.keep(n, image.slice(n * BLOCK, (n + 1) * BLOCK));
    }
    assert.ok(unit.flash.blocks.has(0), 'the image fits the cache');
    await unit.open(SIDE, SIDE);
    await fly(unit, new LogBus(fs.readFileSync(`${tmp}/flight.log`, 'utf8')), 0, 6.1e6, (now) => {
        if (unit.hasNewPicture() && now > 5.85e6) {
            pictures.push(checksum(unit.paint()));
        } else if (now <= 5.85e6) {
            unit.paint();
        }
    });
    assert.ok(new Set(pictures).size > 2, 'pictures near that time differ');
    assert.ok(pictures.includes(shown), `${shown} is none of ${pictures}`);
});

test('reads that come late are waited for, and the picture comes', async () => {
    const source = memorySource(), read = source.read;
    source.read = async (...range) => {
        await new Promise((done) => setTimeout(done, 3));
        return read(...range);
    };
    const unit = await openUnit(source);
    await fly(unit, new Flight({latitude: 46, longitude: 11, headingDeg: 0, heightM: 3000, speedMs: 180}), 0, 2e6);
    assert.ok(unit.flash.count.lateReads > 0);
    assert.ok(unit.value('pictures') > 50);
    assert.deepEqual(unit.warnings(), []);
});

test('never more than 16 MiB of an image are kept, and no more is read than is needed', async () => {
    const unit = await openUnit();
    await fly(unit, new Flight({latitude: 46, longitude: 11, headingDeg: 0, heightM: 3000, speedMs: 180}), 0, 1e6);
    assert.ok(unit.flash.blocks.size * BLOCK <= 16 << 20);
    assert.ok(unit.flash.count.bytes < image.length, `${unit.flash.count.bytes} of ${image.length} bytes`);
});

test('a flash that fails in flight is said on the glass, and one that fails at the start is refused', async () => {
    const source = memorySource(), read = source.read;
    const unit = await openUnit(source);
    source.read = async () => { throw new Error('gone'); };
    await fly(unit, new Flight({latitude: 46, longitude: 11, headingDeg: 0, heightM: 3000, speedMs: 180}), 0, 3e6);
    assert.ok(unit.flash.count.failures > 0);
    assert.ok(unit.warnings().length > 0, 'a flag is up');
    await assert.rejects(openUnit(source), /memory: the image cannot be read/);
    source.read = async (...range) => (await read(...range)).fill(0);
    await assert.rejects(openUnit(source), /no image that this display can use/);
});

test('a server without ranges of bytes is refused, one with them serves the image', async () => {
    const server = await serve(tmp, 0), url = `http://127.0.0.1:${server.address().port}`;
    const source = await httpSource(`${url}/middle.lmdb`);
    assert.equal(source.size, image.length);
    assert.deepEqual(await source.read(1000, 77), image.slice(1000, 1077));
    await assert.rejects(httpSource(`${url}/none.lmdb`), /answers 404/);
    server.on('request', () => {}).close();
    const plain = (await import('node:http')).createServer((_, response) => response.end('all of it'));
    await new Promise((ready) => plain.listen(0, '127.0.0.1', ready));
    await assert.rejects(httpSource(`http://127.0.0.1:${plain.address().port}/x`), /does not serve ranges/);
    plain.close();
});

test('a flight by hand is understood: no warning, and the unit is where the flight is', async () => {
    const unit = await openUnit();
    const flight = new Flight({latitude: 45.95, longitude: 11.02, headingDeg: 0, heightM: 3000, speedMs: 180});
    await fly(unit, flight, 0, 2e6);
    assert.deepEqual(unit.warnings(), []);
    unit.calls.button(true, 9); // the cursor half the range ahead
    await fly(unit, flight, 2e6, 2.2e6);
    const degrees = (name) => (unit.value(name) | 0) * 360 / 2 ** 32;
    const aheadDeg = unit.value('rangeNm') / 2 / 60;
    assert.ok(Math.abs(degrees('cursorLatitude') - flight.latitude - aheadDeg) < 0.004, 'a minute of arc is a mile');
    assert.ok(Math.abs(degrees('cursorLongitude') - 11.02) < 0.001);
    await fly(unit, {deliver: () => {}}, 2.2e6, 6e6); // the bus falls silent
    assert.ok(unit.value('flags') & FLAG_NAV_DEAD);
});

test('a turn by hand has the radius of its bank and speed', () => {
    const flight = new Flight({latitude: 0, longitude: 0, headingDeg: 0, heightM: 3000, speedMs: 150});
    flight.turn(30);
    const radius = 150 ** 2 / (9.80665 * Math.tan(Math.PI / 6));
    for (let n = 0; n < 80 * 120 && flight.headingDeg < 180; n++) {
        flight.advance(0.0125);
    }
    const eastM = flight.longitude * Math.PI / 180 * 6371008.8;
    assert.ok(Math.abs(eastM / (2 * radius) - 1) < 0.002, `${eastM} m of ${2 * radius}`);
});

test('lines that are no data frame are counted, in a log and on a socket', () => {
    assert.deepEqual(parseLine('(12.000034) can0 40C#091E0000404505C2'),
        {id: 0x40c, isExtended: false, data: [9, 30, 0, 0, 0x40, 0x45, 5, 0xc2], timeUs: 12000034});
    assert.equal(parseLine('(1.000000) can0 1F334455#00').isExtended, true);
    for (const line of ['', 'x', '(1.0) can0 123#00', '(1.000000) can0 12#00', '(1.000000) can0 123#0', '(1.000000) can0 123#R',
        '(1.000000) can0 123#001122334455667788']) {
        assert.equal(parseLine(line), null, line);
    }
    assert.throws(() => new LogBus('nothing\n'), /no frame/);
    assert.equal(new LogBus('(1.000000) can0 123#00\nbad\n').refused, 1);
    const socket = Object.assign(Object.create(SocketBus.prototype), {refused: 0, waiting: []});
    socket.take('(1.000000) can0 123#00\nbad\n');
    socket.take(new ArrayBuffer(4));
    socket.take('(1.000000) can0 123#00\n'.repeat(2000));
    assert.deepEqual([socket.waiting.length, socket.refused], [512, 1 + 2000 - 511]);
});

test('frames and acts beyond what a step takes are dropped and counted', async () => {
    const unit = await openUnit(), frame = {id: 1, isExtended: false, data: [1], timeUs: 0};
    for (let n = 0; n < 600; n++) {
        unit.frame(frame);
        unit.calls.drop();
    }
    assert.equal(unit.value('framesLost'), 600 - 512);
    assert.equal(unit.value('actsLost'), 600 - 64);
    assert.equal(unit.frame({...frame, data: Array(9).fill(0)}), false);
});

test('digits are the first ten keys, and with Shift the next ten', () => {
    const key = (code, shiftKey = false) => buttonOf({code, shiftKey});
    assert.deepEqual([key('Digit1'), key('Digit0'), key('Digit1', true), key('Digit0', true)], [1, 10, 11, 20]);
    assert.deepEqual([key('KeyQ'), key('KeyF'), key('KeyZ')], [21, 28, 0]);
});

/* Recordings in the module, in node: flights of random events (tests/replay) show the pictures that
 * the PC's firmware showed, from a whole log and from one that grows, forwards and after jumps.
 * Usage: node test_recording.mjs, in the project's folder; BUILD names the PC's build. */
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import {test} from 'node:test';

import {FeedLines, joined, LogLines, Moments, Replay, spanOf} from '../../bsp/web/page/recording.mjs';

const build = process.env.BUILD ?? 'build/bench-linux', tmp = `${build}/tmp/web/recording`;
const program = (name, ...words) => execFileSync(`${build}/bin/${name}`, words, {encoding: 'utf8'});
const FLIGHTS = 7;

fs.rmSync(tmp, {recursive: true, force: true});
fs.mkdirSync(tmp, {recursive: true});
program('tests/replay/flights', 'image', `${tmp}/image.lmdb`);
program('tests/replay/flights', 'record', `${tmp}/image.lmdb`, tmp, '1', String(FLIGHTS));
const moduleBytes = fs.readFileSync('build/web/landmass.wasm');

const bytesSource = (name, bytes) => ({name, size: bytes.length, read: (at, length) => bytes.subarray(at, at + length)});
const fileSource = (path) => bytesSource(path, new Uint8Array(fs.readFileSync(path)));
const image = fileSource(`${tmp}/image.lmdb`);
const textOf = (seed) => fs.readFileSync(`${tmp}/${seed}.log`, 'latin1');
const sumsOf = (seed) => fs.readFileSync(`${tmp}/${seed}.sums`, 'utf8').trim().split('\n');
const linesOf = (text) => new LogLines(bytesSource('text', new Uint8Array(Buffer.from(text, 'latin1'))));

async function opened(lines, flash = image) {
    const replay = await Replay.load(moduleBytes, flash);
    replay.open(lines);
    return replay;
}

/* Checksums of the pictures that the steps show which can be taken now. */
function fly(replay) {
    const sums = [];
    while (replay.isReady() && replay.step()) {
        if (replay.hasNewPicture()) {
            sums.push(replay.checksum().toString(16).padStart(8, '0'));
        }
    }
    return sums;
}

test('more than a thousand pictures of random flights are those of the PC, bit for bit', async () => {
    let pictures = 0;
    for (let seed = 1; seed <= FLIGHTS; seed++) {
        const replay = await opened(new LogLines(fileSource(`${tmp}/${seed}.log`)));
        const sums = fly(replay);
        assert.deepEqual(sums, sumsOf(seed), `flight ${seed}`);
        assert.equal(replay.problem(), '');
        assert.ok(replay.value('hasEnded') === 1 && replay.value('checks') > 10);
        pictures += sums.length;
    }
    assert.ok(pictures > 1000, `${pictures} pictures`);
});

test('a recording that grows shows the same, whatever pieces it comes in, and waits in between', async () => {
    const text = textOf(1), feed = new FeedLines(), sums = [];
    let at = 0, seed = 1, replay = null, waits = 0;
    while (at < text.length) {
        seed = seed * 1103515245 + 12345 >>> 0;
        const length = 1 + (seed >>> 16) % 900;
        feed.put(text.slice(at, at + length));
        at += length;
        if (!replay && feed.steps > 0) {
            replay = await opened(feed);
        }
        const more = replay ? fly(replay) : [];
        waits += more.length === 0;
        sums.push(...more);
        assert.ok(!replay?.isOver || feed.isOver, `over at ${at} of ${text.length}`);
    }
    assert.deepEqual(sums, sumsOf(1));
    assert.ok(waits > 10);
    assert.equal(replay.problem(), '');
    assert.equal(replay.value('hasEnded'), 1);
});

test('a recording in parts is one', async () => {
    const text = textOf(5), bytes = new Uint8Array(Buffer.from(text, 'latin1')), cuts = [0, 7, 65536, 65600, 100000, bytes.length];
    const parts = cuts.slice(1).map((end, n) => bytesSource(`${n}`, bytes.subarray(cuts[n], end)));
    const whole = joined(parts);
    assert.deepEqual(whole.read(3, 70000), bytes.subarray(3, 70003));
    assert.deepEqual(fly(await opened(new LogLines(whole))), sumsOf(5));
});

test('back and on again by moments, within their memory, the pictures are the same', async () => {
    const most = 36 << 20, moments = new Moments(most, 100000);
    const replay = await opened(new LogLines(fileSource(`${tmp}/2.log`))), sums = sumsOf(2);
    do {
        moments.keep(replay);
    } while (replay.step());
    assert.ok(moments.bytes <= most && moments.all.length > 4, `${moments.all.length} moments, ${moments.bytes} bytes`);
    assert.ok(moments.apartUs > 100000, 'some were dropped');
    const kinds = ['symbols', 'at', 'words'].map((part) => moments.all.flatMap(({pages}) => pages).filter((page) => page?.[part]).length);
    assert.ok(kinds.every((count) => count > 20), `${kinds} pages of each kind`);
    const {bytes} = moments;
    moments.count();
    assert.ok(moments.bytes <= bytes, `${moments.bytes} bytes, reckoned as ${bytes}`);
    for (const wanted of [150, 20, 149, 60, 2, sums.length]) {
        replay.restore(moments.last((m) => m.pictures < wanted));
        while (replay.value('pictures') < wanted) {
            assert.ok(replay.step());
        }
        assert.equal(replay.checksum().toString(16).padStart(8, '0'), sums[wanted - 1], `picture ${wanted}`);
    }
    const other = await opened(new LogLines(fileSource(`${tmp}/2.log`)));
    other.restore(moments.last((m) => m.pictures < 100));
    const from = other.value('pictures');
    assert.deepEqual(fly(other), sums.slice(from));
    assert.equal(other.problem(), '');
});

test('what was recorded by landmass-sim is what landmass-sim --replay shows', async () => {
    program('landmass-nav', '--straight', '45.95,11,0,3000,180', '--seconds', '9', '--out', `${tmp}/bus.log`);
    fs.writeFileSync(`${tmp}/script`, '1 osb 19\n3 osb 1\n4 osb 19\n');
    const flight = ['--db', `${tmp}/image.lmdb`, '--every', '0', '--quiet'];
    program('landmass-sim', ...flight, '--bus', `${tmp}/bus.log`, '--seconds', '6', '--script', `${tmp}/script`,
        '--png', tmp, '--record', `${tmp}/sim.log`);
    fs.mkdirSync(`${tmp}/again`, {recursive: true});
    program('landmass-sim', ...flight, '--replay', `${tmp}/sim.log`, '--png', `${tmp}/again`, '--every', '1');
    const shown = fs.readdirSync(`${tmp}/again`).map((name) =>
        program('tests/zcu102/picture_checksum', `${tmp}/again/${name}`).trim().split(' ').at(-1));
    const log = fileSource(`${tmp}/sim.log`), replay = await opened(new LogLines(log));
    const sums = new Set(fly(replay));
    assert.equal(replay.problem(), '');
    assert.ok(shown.length >= 5 && new Set(shown).size >= 4, `${shown}`);
    shown.forEach((sum) => assert.ok(sums.has(sum), `${sum} is none of ${sums.size}`));
    const [first, last] = spanOf(log);
    assert.ok(Math.abs((last - first) / 1e6 - 6) < 0.1, `${(last - first) / 1e6} s`);
});

test('a step that is lost, a frame that is changed and another image are seen', async () => {
    const text = textOf(3), lines = text.split('\n');
    const steps = lines.findIndex((line, n) => n > 3000 && line.includes('unit 1F4C4D01#'));
    const lost = await opened(linesOf(lines.toSpliced(steps, 1).join('\n')));
    fly(lost);
    assert.match(lost.problem(), /not the flight recorded|no time of a step/);
    const sent = lines.findIndex((line, n) => n > 3000 && / sent .*#.*[0-8]$/.test(line));
    const changed = await opened(linesOf(lines.with(sent, lines[sent].slice(0, -1) + '9').join('\n')));
    fly(changed);
    assert.match(changed.problem(), /departures 1/);
    const other = new Uint8Array(image.read(0, image.size));
    other[100] ^= 1;
    await assert.rejects(opened(linesOf(text), bytesSource('other', other)), /made with another image/);
    other[100] ^= 1;
    other.fill(0, 4096);
    const holed = await opened(linesOf(text), bytesSource('holed', other));
    fly(holed);
    assert.match(holed.problem(), /reads that differ [1-9]/);
});

test('an image that cannot be read ends the replay with a word', async () => {
    let isGone = false;
    const source = {...image, read: (...range) => {
        if (isGone) {
            throw new Error('gone');
        }
        return image.read(...range);
    }};
    const replay = await Replay.load(moduleBytes, source);
    replay.open(linesOf(textOf(1)));
    replay.blocks.blocks.clear();
    isGone = true;
    fly(replay);
    assert.match(replay.problem(), /the image cannot be read at \d+/);
});

test('any bytes are safe: a line that is none is named, a torn end is left out', async () => {
    const all = textOf(4), text = all.slice(0, Math.min(200000, all.length * 3 / 4)), replay = await Replay.load(moduleBytes, image);
    const end = (changed) => {
        try {
            replay.open(linesOf(changed));
        } catch (error) {
            return error.message;
        }
        fly(replay);
        return replay.problem();
    };
    assert.equal(end(text.slice(0, 150017)), '', 'torn');
    assert.equal(replay.remark(), 'the recording has no end');
    const whole = text.slice(0, text.lastIndexOf('\n') + 1), head = whole.split('\n').findLastIndex((line) => / unit 1F4C4D00#/.test(line));
    const lines = whole.split('\n'), last = lines[head];
    lines[head] = last.slice(0, -1) + (last.endsWith('1') ? '2' : '1'); // of the build's identity
    assert.equal(end(lines.join('\n') + '(1700000001.000000) unit 1F4C4D11#0201000000\n'), '');
    assert.match(replay.remark(), /recorded by another build.*; the recorder gave up here: lines came faster/);
    assert.match(end(''), /does not begin as a recording/);
    assert.match(end('(1.000000) can0 123#00\n'), /does not begin as a recording/);
    assert.match(end(text.replace(/\n/, '\nno line\n')), /recording line 2: no time stamp|begin as a recording/);
    for (const bad of ['\0', 'x'.repeat(300), '(1.000000) unit 1F4C4DFF#00']) {
        const at = text.indexOf('\n', 100000) + 1;
        assert.match(end(text.slice(0, at) + bad + '\n' + text.slice(at)), /^recording line \d+: /, JSON.stringify(bad.slice(0, 30)));
    }
    let seed = 7;
    const random = (below) => (seed = seed * 1103515245 + 12345 >>> 0, (seed >>> 8) % below);
    for (let n = 0; n < 200; n++) {
        const at = random(20000), to = random(2) ? String.fromCharCode(random(256)) : text.slice(random(20000), random(20000));
        end(text.slice(0, at) + to + text.slice(at + random(80), 20000));
    }
    const feed = new FeedLines();
    feed.put('x'.repeat(1e6));
    feed.put('y'.repeat(1e6));
    assert.ok(feed.rest.length < 300, 'a line without end takes no memory');
});

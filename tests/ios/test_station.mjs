/* The modules of the instructor's page in node: frames against `landmass-nav` and `landmass-bus`, which
 * are C, and against the firmware in its module; what pages agree upon; ways of targets.
 *
 * Usage: node test_station.mjs, in the project's folder; BUILD names the PC's build, whose folder `ios`
 * is the site. */
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';
import {pathToFileURL} from 'node:url';

const build = process.env.BUILD ?? 'build/bench-linux', tmp = `${build}/tmp/ios`;
const site = (name) => import(pathToFileURL(path.resolve(build, 'ios', name)));
const program = (name, ...words) => execFileSync(`${build}/bin/${name}`, words, {encoding: 'utf8', maxBuffer: 1 << 26});
const F = await site('frames.mjs'), {ahead, between, clockOf, clockWords} = await site('geo.mjs'),
    {Target} = await site('targets.mjs');
const {World} = await site('world.mjs'), {Keeper} = await site('keeper.mjs'), {Commands} = await site('commands.mjs');
const {parseLine} = await site('web/bus.mjs'), {squareOf, placeOf} = await site('map.mjs');

fs.mkdirSync(tmp, {recursive: true});

/* What `landmass-bus decode` says of lines. */
function decode(lines) {
    const file = `${tmp}/lines.log`;
    fs.writeFileSync(file,
        lines.map((line, i) => `${line.replace('(0.000000)', `(1.${String(i * 200).padStart(6, '0')})`)}\n`).join(''));
    return program('landmass-bus', 'decode', file);
}

const near = (a, b, apart) => assert.ok(Math.abs(a - b) <= apart, `${a} is not ${b}`);
const factsOf = (lines) => {
    const reader = new F.Reader();
    return lines.flatMap((line) => reader.take(parseLine(line)));
};

test('a saved list of events keeps commas, quotes and lines in their fields', async () => {
    const {csvOf} = await site('events.mjs');
    const events = [{busUs: 1.7e15, exerciseMs: 3723000, text: 'Rain 1, told', by: 'this page'},
        {busUs: 1.7e15 + 1.5e6, exerciseMs: null, text: 'a "quoted"\nname', by: 'nobody'}];
    assert.equal(csvOf(events), 'utc,exercise,event,by\r\n2023-11-14T22:13:20.000Z,1:02:03,"Rain 1, told",this page\r\n'
        + '2023-11-14T22:13:21.500Z,,"a ""quoted""\nname",\r\n');
});

/* ---- frames ---- */

test('a live target is what landmass-bus reads of it', () => {
    const target = {kind: 13, latitude: 46.1234567, longitude: -11.7654321, speedMs: 12.5, courseDeg: 216.87,
        heightM: 250, rcsDbsm: 31, signature: 2};
    const told = decode(F.linesOf(F.targetFrames(200, target), 31, 7));
    for (const words of ['kind 13, reckoning 2, signature 2, parts 15 (number 200, set 7)',
        'live-latitude 46.1234567 deg',
        'live-longitude -11.7654321 deg', 'live-height 250.000 m', 'east -7.5 m/s, north -10 m/s',
            'node 31 service 200 code 7 FLOAT 31']) {
        assert.ok(told.includes(words), `${words}\n${told}`);
    }
    assert.ok(!/refused|not used/.test(told), told);
});

test('every frame of the page is taken by landmass-bus as it was meant', () => {
    const place = {latitude: -45.5, longitude: 170.25};
    const expected = [
        [F.rainFrames(3, {...place, radiusM: 4000, rateMmH: 30}), 'rain-latitude -45.5', 'rain-longitude 170.25',
            'rain-radius 4000.000 m', 'rain-rate 30.000 mm/h'],
        [F.jammerFrames(1, {...place, ratioDb: -12.5}), 'jammer-latitude -45.5', 'jammer-longitude 170.25',
            'jammer-ratio -12.500 dB'],
        [F.seaFrames(6), 'sea-state 6'], [F.windFrames(270), 'wind-direction -90'],
            [F.clearWeatherFrames(255), 'weather-clear 255'],
        [F.removeTargetFrames(9), 'live-remove'], [F.clearTargetsFrames(), 'live-clear'],
        [F.clockFrames({timeMs: 3600003, rate: 0.5, seed: 7}), 'exercise-seed 7.000', 'exercise-rate 0.500 x',
            'exercise-time 3600003.000 ms'],
        [F.malfunctionFrames(3, -15), 'service 3', 'malfunction -15.000 amount'],
            [F.clearMalfunctionFrames(255), 'malfunction-clear 255']];
    for (const [frames, ...words] of expected) {
        const told = decode(F.linesOf(frames, 31, 200));
        words.forEach((w) => assert.ok(told.includes(w), `${w}\n${told}`));
        assert.ok(!/refused|not used/.test(told.split('\n').slice(0, frames.length).join('\n')), told);
    }
});

test('every control of the page is a control of landmass-bus', () => {
    const C = F.controlFrames;
    const expected = [[C.key(true, 12), /control key: .*service 1 .*UCHAR 12/],
        [C.key(false, 12), /control key: .*service 0 .*UCHAR 12/],
        [C.switch(2), /control switch: .*UCHAR 2/], [C.knob(-1000), /range knob: .*LONG -1000/],
            [C.slew(1000, -1000), /slew right: .*LONG 1000[^]*slew up: .*LONG -1000/],
        [C.sector(2, 1), /control sector: .*UCHAR2 2 1/], [C.rangeScale(40), /range scale: .*LONG 40/],
            [C.sectorWidth(1), /sector width: .*UCHAR 1/],
        [C.gain(-3), /control gain: .*CHAR -3/], [C.cursor(46.5, 11),
            /cursor latitude: .*LONG 465000000[^]*cursor longitude: .*LONG 110000000/],
        [C.steer(46.5, 11), /steer latitude: .*service 0[^]*steer longitude/],
            [C.steerOff(), /steer latitude: .*service 1[^]*steer longitude: .*service 1/],
        [C.patch(46, 11, 5),
            /patch latitude: .*service 4[^]*patch longitude: .*service 4[^]*patch cell: .*service 4 .*LONG 5000/]];
    for (const [frames, words] of expected) {
        assert.match(decode(F.linesOf(frames, 31, 1)), words);
    }
});

test('what landmass-nav tells is read as it was told', () => {
    const file = `${tmp}/nav.log`;
    program('landmass-nav', '--straight', '46,11,30,3000,150', '--seconds', '3', '--rain', '46.1,11.2,4000,30',
        '--jammer', '46.2,11.1,30', '--live',
        '3,13,46.1,11,90,15', '--live', '5,6,46.3,11,180,40,1200,3', '--exercise-clock', '3600', '--exercise-seed', '7',
            '--malfunction', 'weak-transmit=20',
        '--out', file, '--quiet');
    const world = new World(), reader = new F.Reader();
    for (const line of fs.readFileSync(file, 'utf8').trim().split('\n')) {
        const frame = parseLine(line);
        world.nowUs = Math.max(world.nowUs, frame.timeUs);
        reader.take(frame).forEach((fact) => world.take(fact, `node ${fact.node}`));
    }
    assert.equal(reader.refused, 0);
    const own = world.ownAircraft(), ship = world.targets.get(3), aircraft = world.targets.get(5);
    const along = between({latitude: 46, longitude: 11}, own);
    near(along.distanceM, 150 * 3, 20);
    near(along.bearingDeg, 30, 0.5);
    near(own.headingDeg, 30, 0.1);
    assert.deepEqual([ship.kind, ship.speedMs, Math.round(ship.courseDeg), ship.heightM], [13, 15, 90, null]);
    assert.deepEqual([aircraft.kind, aircraft.heightM], [6, 1200]);
    near(aircraft.turnDegS, 3, 0.01);
    assert.deepEqual([world.rain.get(0).rateMmH, world.rain.get(0).radiusM, world.jammer.get(0).ratioDb],
        [30, 4000, 30]);
    assert.deepEqual([world.clock.seed, world.clock.rate, world.malfunctions.get(1).amount], [7, 1, 20]);
    near(world.exerciseMs(), 3603000, 20);
});

test('positions of every type that the bus has are read', () => {
    for (const type of ['double', 'float', 'long']) {
        const file = `${tmp}/${type}.log`, world = new World(), reader = new F.Reader();
        program('landmass-nav', '--straight', '46,-179.9999,90,3000,150', '--seconds', '2', '--position', type, '--out',
            file, '--quiet');
        fs.readFileSync(file, 'utf8').trim().split('\n').forEach((line) =>
            reader.take(parseLine(line)).forEach((fact) => world.take(fact, 'a')));
        near(world.own.latitude.value, 46, 1e-4);
        near(world.own.longitude.value, -179.9961, 4e-4);
    }
});

test('the words of the state are those of the glass', async () => {
    const source = fs.readFileSync('firmware/display/overlay.c', 'utf8');
    const words = /flag_words\[LM_FLAGS\]\[9\] = \{([^}]*)\}/.exec(source)[1].match(/"[^"]*"/g)
        .map((w) => w.slice(1, -1));
    assert.deepEqual(F.FLAG_WORDS, words);
});

test('kinds and amounts are those of docs/bus.md', () => {
    const page = fs.readFileSync('docs/bus.md', 'utf8');
    F.KINDS.forEach((name, n) => assert.ok(page.includes(`| ${n} ${name} |`), `${n} ${name}`));
    for (const n of [0, 1, 2, 3, 4, 7, 8, 9]) {
        assert.ok(page.includes(`| ${n} | ${F.MALFUNCTIONS[n].name} |`), F.MALFUNCTIONS[n].name);
    }
});

test('hostile frames give no fact', () => {
    const reader = new F.Reader();
    const bad = ['(1.000000) a 712#1F0200007FC00000', '(1.000000) a 710#1F0A000009',
        '(1.000000) a 721#1F02000BFFFFFFFF',
        '(1.000000) a 721#1F020B0041A00000', '(1.000000) a 717#1F100005020A0000', '(1.000000) a 708#1F02040042380000',
            '(1.000000) a 71C#1F030000FFFFFFFF',
        '(1.000000) a 708#', '(1.000000) a 708#1F', '(1.000000) a 70A#1F02000042C6',
            '(1.000000) a 40C#0002000042380000', '(1.000000) a 71D#1F02000041C00000'];
    bad.forEach((line) => assert.deepEqual(reader.take(parseLine(line)), [], line));
    let seed = 1;
    const random = (below) => (seed = (seed * 1103515245 + 12345) % 2 ** 31) % below;
    const world = new World();
    for (let n = 0; n < 200000; n++) {
        const id = [1036 + random(20), 1500 + random(50), 1800 + random(30)][random(3)];
        const frame = {id, isExtended: false, data: Array.from({length: random(9)},
            () => random(4) ? random(256) : random(32)), timeUs: n * 500};
        world.nowUs = frame.timeUs;
        reader.take(frame).forEach((fact) => world.take(fact, 'x'));
    }
    assert.ok(world.events.length <= 500 && world.targets.size <= 256 && world.rain.size <= 4
        && reader.sets.size < 3 * 256 * 256);
});

/* ---- pages that share a bus ---- */

/* A bus that gives back what pages send, in order, to every page; and its time. */
class Bus {
    constructor() {
        Object.assign(this, {ms: 1000, pages: [], log: [], queue: []});
    }

    page(random) {
        const world = new World(), reader = new F.Reader(), page = {world, heard: [], isThere: true, reports: []};
        page.keeper = new Keeper({send: (text) => this.queue.push(...text.split('\n')), nowMs: () => this.ms,
            node: F.STATION_NODE, random: () => random});
        page.commands = new Commands(world, page.keeper);
        page.take = (line) => reader.take({...parseLine(line), timeUs: this.ms * 1000}).forEach((fact) => {
            const isHeard = world.take(fact, page.keeper.isOwn(fact) ? 'this page' : 'another page'),
                lost = page.keeper.hear(fact, isHeard);
            page.reports.push(...lost ? [lost] : []);
        });
        this.pages.push(page);
        return page;
    }

    deliver() {
        while (this.queue.length > 0) {
            const line = this.queue.shift();
            this.log.push([this.ms, line]);
            this.pages.filter((page) => page.isThere).forEach((page) => page.take(line));
        }
    }

    run(seconds) {
        for (const end = this.ms + 1000 * seconds; this.ms < end; this.ms += 50) {
            this.deliver();
            for (const page of this.pages.filter((p) => p.isThere)) {
                page.world.tick(this.ms * 1000);
                page.commands.tick();
            }
        }
        this.deliver();
    }

    /* How many frames of an identifier went out in the last seconds. */
    count(id, seconds) {
        return this.log.filter(([ms, line]) => ms > this.ms - 1000 * seconds && parseLine(line).id === id).length;
    }
}

const CAR = {kind: 2, latitude: 46, longitude: 11, speedMs: 20, courseDeg: 90};

test('a target that is placed is told once a second, and moves', () => {
    const bus = new Bus(), a = bus.page(0.2);
    assert.equal(a.commands.placeTarget(CAR), 0);
    assert.equal(a.world.targets.size, 0, 'nothing is shown before it came back');
    bus.run(10);
    near(bus.count(1810, 9), 9, 1);
    const told = a.world.targets.get(0);
    near(between(CAR, a.world.reckoned(told)).distanceM, 200, 4);
    assert.deepEqual(a.world.events.map((e) => e.text).length, 1, 'its way is no event');
});

test('what another page changes this page gives up, and both show the same', () => {
    const bus = new Bus(), a = bus.page(0.2), b = bus.page(0.7);
    a.commands.placeTarget(CAR);
    bus.run(3);
    assert.ok(b.commands.changeTarget(0, {kind: 13, speedMs: 5}));
    bus.run(5);
    assert.deepEqual([a.keeper.keys, b.keeper.keys, a.reports], [[], ['target 0'], ['target 0']]);
    near(bus.count(1810, 4), 4, 1);
    const [of, on] = [a, b].map((page) => page.world.targets.get(0));
    assert.deepEqual([of.kind, of.speedMs, of.latitude], [13, 5, on.latitude]);
});

test('two wishes at one moment end in one answer for both', () => {
    const bus = new Bus(), a = bus.page(0.2), b = bus.page(0.7);
    a.commands.sea(2);
    b.commands.sea(6);
    bus.run(6);
    assert.equal(a.world.sea.value, b.world.sea.value);
    assert.equal(a.keeper.keys.length + b.keeper.keys.length, 1);
    near(bus.count(1808, 4), 4, 1);
});

test('a wish and a repeat that cross: the wish stays', () => {
    const bus = new Bus(), a = bus.page(0.2), b = bus.page(0.7);
    a.commands.sea(2);
    bus.run(3);
    b.commands.sea(6);
    a.keeper.refresh('sea'); // under way when the wish was on the bus
    bus.run(4);
    assert.deepEqual([a.world.sea.value, b.world.sea.value], [6, 6]);
});

test('what is removed while its repeat is under way does not come back', () => {
    const bus = new Bus(), a = bus.page(0.2), b = bus.page(0.7);
    a.commands.placeTarget(CAR);
    bus.run(3);
    b.commands.removeTarget(0);
    a.keeper.refresh('target 0');
    bus.run(5);
    assert.deepEqual([a.world.targets.size, b.world.targets.size], [0, 0]);
});

test('a page that goes away leaves its exercise to another, before the displays drop it', () => {
    const bus = new Bus(), a = bus.page(0.2), b = bus.page(0.7), c = bus.page(0.1);
    a.commands.placeTarget({...CAR, heightM: 100});
    a.commands.circle('rain', null, {latitude: 46, longitude: 11, radiusM: 5000, rateMmH: 40});
    a.commands.malfunction(3, -15);
    a.commands.clock({timeMs: 60000, rate: 1, seed: 5});
    a.commands.sea(4);
    bus.run(5);
    a.isThere = false;
    let silentMs = 0;
    for (let n = 0; n < 200; n++) {
        bus.run(0.05);
        silentMs = Math.max(silentMs, bus.ms - bus.log.findLast(([, line]) => parseLine(line).id === 1810)[0]);
    }
    assert.ok(silentMs < 3000, `silent for ${silentMs} ms`);
    assert.equal(b.keeper.keys.length + c.keeper.keys.length, 5);
    near(between(CAR, b.world.reckoned(b.world.targets.get(0))).distanceM, 20 * 15, 10);
    near(b.world.exerciseMs(), 60000 + 15000, 250);
    assert.deepEqual([b.world.malfunctions.get(3).amount, b.world.sea.value, b.world.clock.seed,
        b.world.targets.get(0).heightM], [-15, 4, 5, 100]);
    b.isThere = c.isThere = false;
});

test('what a page has just removed is no orphan, however long its removal takes to come back', () => {
    let now = 0;
    const keeper = new Keeper({send: () => {}, nowMs: () => now, node: 31, random: () => 0});
    const things = [{key: 'malfunction 3', timeUs: 0, node: 31}];
    keeper.keep('malfunction 3', () => F.malfunctionFrames(3, 1));
    now = 5000;
    keeper.remove(['malfunction 3'], F.clearMalfunctionFrames(3));
    assert.deepEqual(keeper.orphans(things, 5e6), []);
    now = 9000; // it was lost: the displays still have the thing
    assert.equal(keeper.orphans(things, 9e6).length, 1);
});

test('what nobody tells any more ends after ten seconds, as on the displays', () => {
    const bus = new Bus(), a = bus.page(0.2);
    a.commands.placeTarget(CAR);
    a.commands.malfunction(7, 0);
    bus.run(2);
    a.keeper.kept.clear();
    a.keeper.orphans = () => [];
    bus.run(9);
    assert.deepEqual([a.world.targets.size, a.world.malfunctions.size], [1, 1]);
    assert.ok(a.world.isStale(a.world.targets.get(0)));
    bus.run(2);
    assert.deepEqual([a.world.targets.size, a.world.malfunctions.size], [0, 0]);
    assert.ok(a.world.events.at(-1).text.includes('not told for 10 s'));
});

test('a thing that another node tells is not heard, and the page says so', () => {
    const bus = new Bus(), a = bus.page(0.2);
    a.take(F.linesOf(F.clockFrames({timeMs: 5000, rate: 1}), 30, 1).join('\n').split('\n')[0]);
    bus.run(0.1);
    a.commands.clock({rate: 0});
    bus.run(1);
    assert.equal(a.world.clock.rate, 1);
    assert.deepEqual(a.reports, ['clock']);
    assert.deepEqual(a.keeper.keys, []);
});

test('what the server refuses is not asked for again', () => {
    const bus = new Bus(), a = bus.page(0.2);
    a.commands.sea(3);
    bus.run(1);
    a.commands.placeTarget(CAR);
    bus.queue.length = 0; // it never comes back
    assert.deepEqual(a.keeper.dropUnheard(), ['target 0']);
    assert.deepEqual(a.keeper.keys, ['sea']);
});

test('where the time of the bus is set back all begins anew', () => {
    const bus = new Bus(), a = bus.page(0.2);
    a.commands.placeTarget(CAR);
    bus.run(2);
    a.world.restart(5e5);
    assert.deepEqual([a.world.targets.size, a.world.clock, a.world.nowUs, a.world.events.length], [0, null, 5e5, 2]);
});

test('message codes of a group go on by one, whichever page tells', () => {
    const bus = new Bus(), a = bus.page(0.2), b = bus.page(0.7);
    a.commands.placeTarget(CAR);
    bus.run(2.3);
    b.commands.placeTarget({...CAR, latitude: 46.1});
    bus.run(6);
    const codes = bus.log.map(([, line]) => parseLine(line)).filter(({id}) => id === 1810).map(({data}) => data[3]);
    assert.ok(codes.length > 10);
    codes.slice(1).forEach((code, i) => assert.equal(code, (codes[i] + 1) & 255));
});

/* ---- the exercise's clock and ways ---- */

test('frozen, a target stands, and goes on where it stood', () => {
    const bus = new Bus(), a = bus.page(0.2);
    a.commands.clock({timeMs: 0, rate: 1});
    a.commands.placeTarget(CAR);
    bus.run(5);
    a.commands.clock({rate: 0});
    bus.run(5);
    const stood = a.world.reckoned(a.world.targets.get(0));
    near(between(CAR, stood).distanceM, 100, 4);
    near(a.world.exerciseMs(), 5000, 150);
    a.commands.clock({rate: 2});
    bus.run(5);
    near(between(CAR, a.world.reckoned(a.world.targets.get(0))).distanceM, 300, 12);
    near(a.world.exerciseMs(), 15000, 300);
});

test('a jump of the clock moves no target', () => {
    const bus = new Bus(), a = bus.page(0.2);
    a.commands.clock({timeMs: 0, rate: 1});
    a.commands.placeTarget(CAR);
    bus.run(2);
    a.commands.clock({timeMs: 3600000});
    bus.run(2);
    assert.ok(between(CAR, a.world.reckoned(a.world.targets.get(0))).distanceM < 200);
    near(a.world.exerciseMs(), 3602000, 100);
});

test('a target follows its way with its speed, and stands at the end', () => {
    const start = {latitude: 46, longitude: 11}, first = ahead(start, 0, 1000), second = ahead(first, 90, 500);
    const t = new Target({number: 0, kind: 2, ...start, speedMs: 50, route: [first, second]});
    near(t.courseDeg, 0, 1e-6);
    let corners = 0;
    for (let s = 0; s < 20.5; s += 0.5) {
        corners += t.advance(0.5) ? 1 : 0;
    }
    near(t.courseDeg, 90, 0.1);
    near(between(first, t).distanceM, 25, 1);
    assert.equal(corners, 1);
    for (let s = 0; s < 20; s++) {
        t.advance(1);
    }
    assert.deepEqual([t.speedMs, t.route.length], [0, 0]);
    near(between(second, t).distanceM, 0, 0.01);
});

test('a way that goes round and round does not end', () => {
    const corners = [[46, 11], [46.01, 11], [46.01, 11.01]].map(([latitude, longitude]) => ({latitude, longitude}));
    const t = new Target({number: 0, kind: 2, ...corners[0], speedMs: 100, route: [corners[1], corners[2], corners[0]],
        isLoop: true});
    for (let s = 0; s < 300; s++) {
        t.advance(1);
    }
    assert.deepEqual([t.speedMs, t.route.length], [100, 3]);
    new Target({number: 0, kind: 2, ...corners[0], speedMs: 100, route: [corners[0]], isLoop: true}).advance(1); // ends
});

test('clocks and places are read and written', () => {
    assert.deepEqual(['1:02:03', '2:03', '90', '0.5', 'x', '-1', '999:00:00', ''].map(clockOf),
        [3723000, 123000, 90000, 500, null, null, null, null]);
    assert.equal(clockWords(3723999), '1:02:03');
    for (const place of [{latitude: 60, longitude: -179.5}, {latitude: -33.3, longitude: 151}]) {
        const back = placeOf(squareOf(place));
        near(back.latitude, place.latitude, 1e-9);
        near(back.longitude, place.longitude, 1e-9);
    }
    assert.deepEqual(squareOf({latitude: 0, longitude: 0}), [0.5, 0.5]);
});

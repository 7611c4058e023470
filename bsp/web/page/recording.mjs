/* A recording of a flight (docs/FORMATS.md, 2.8), flown again by the module: the law is the
 * firmware's own (bsp/record/replay.c). Runs in a worker or in node, where files and servers can be
 * read without waiting.
 *
 *     const replay = await Replay.load(moduleBytes, image);     image, log: {name, size, read}
 *     replay.open(new LogLines(log));
 *     while (replay.step()) { ... replay.nowUs, replay.paint(), replay.checksum() }
 *     replay.problem()                                          '' if it was the flight recorded
 *
 * `read(offset, length)` returns a Uint8Array of that length, or throws. */
import {Unit} from './unit.mjs';

const BLOCK = 65536, BLOCKS_KEPT = 512; // 32 MiB of an image
const OK = 0, IO_ERROR = -1;            // lm/status.h
const OVER = -1, TORN = -2, BAD = -3;   // enum of exports.h
const CEASED = [, 'it is as long as it may be', 'lines came faster than they could be written', // enum record_reason
    'it could not be written'];
const LINE_MOST = 127;
const LINE_FEED = 10;
const IS_STEPS = / unit 1F4C4D01#/, IS_END = / unit 1F4C4D(0D|11)#/;

/* ---- sources ---- */

/* Bytes of a server, by ranges. In a worker alone: a page may not wait. */
export function waitingHttpSource(url) {
    const ask = (range) => {
        const request = new XMLHttpRequest();
        request.open('GET', url, false);
        request.responseType = 'arraybuffer';
        request.setRequestHeader('Range', range);
        request.send();
        return request;
    };
    const probe = ask('bytes=0-0'), range = /^bytes 0-0\/(\d+)$/.exec(probe.getResponseHeader('Content-Range') ?? '');
    if (probe.status !== 206 || !range) {
        throw new Error(probe.status >= 400 ? `${url}: the server answers ${probe.status}`
            : `${url}: the server does not serve ranges of bytes; one that does is serve.mjs`);
    }
    const read = (offset, length) => {
        const answer = ask(`bytes=${offset}-${offset + length - 1}`);
        const bytes = new Uint8Array(answer.response ?? 0);
        if (answer.status !== 206 || bytes.length !== length) {
            throw new Error(`${url}: ${bytes.length} bytes with status ${answer.status} instead of ${length}`);
        }
        return bytes;
    };
    return {name: url, size: Number(range[1]), read};
}

/* A file that was dropped on the page, in a worker. */
export function waitingFileSource(file) {
    const read = (offset, length) =>
        new Uint8Array(new FileReaderSync().readAsArrayBuffer(file.slice(offset, offset + length)));
    return {name: file.name, size: file.size, read};
}

/* Parts of a recording, one after the other, as one source. */
export function joined(parts) {
    const begins = parts.reduce((all, part) => [...all, all.at(-1) + part.size], [0]);
    const read = (offset, length) => {
        const bytes = new Uint8Array(length);
        for (let done = 0; done < length;) {
            const n = begins.findLastIndex((begin, i) => i < parts.length && begin <= offset + done);
            const at = offset + done - begins[n], most = Math.min(length - done, parts[n].size - at);
            bytes.set(parts[n].read(at, most), done);
            done += most;
        }
        return bytes;
    };
    return parts.length === 1 ? parts[0] : {name: parts[0].name, size: begins.at(-1), read};
}

/* Blocks of a source, the last ones kept. */
class Blocks {
    constructor(source, kept) {
        this.source = source;
        this.kept = kept;
        this.blocks = new Map();
    }

    block(n) {
        const bytes = this.blocks.get(n)
            ?? this.source.read(n * BLOCK, Math.min(BLOCK, this.source.size - n * BLOCK));
        this.blocks.delete(n);
        this.blocks.set(n, bytes);
        if (this.blocks.size > this.kept) {
            this.blocks.delete(this.blocks.keys().next().value);
        }
        return bytes;
    }

    copy(offset, to) {
        for (let done = 0; done < to.length;) {
            const at = offset + done, block = this.block(Math.floor(at / BLOCK));
            const part = block.subarray(at % BLOCK, at % BLOCK + to.length - done);
            to.set(part, done);
            done += part.length;
        }
    }
}

/* The lines of a recording that is whole. `at` may be kept and set again. */
export class LogLines {
    constructor(source) {
        this.source = source;
        this.blocks = new Blocks(source, 8);
        this.at = 0;
    }

    isReady() {
        return true;
    }

    /* Copy a line to bytes; as web_recording_line of exports.h. */
    next(to) {
        const most = Math.min(to.length + 1, this.source.size - this.at);
        if (most <= 0) {
            return OVER;
        }
        let block = this.blocks.block(Math.floor(this.at / BLOCK)).subarray(this.at % BLOCK, this.at % BLOCK + most);
        if (block.length < most && !block.includes(LINE_FEED)) {
            block = new Uint8Array(most);
            this.blocks.copy(this.at, block);
        }
        const end = block.indexOf(LINE_FEED);
        if (end < 0) {
            return most > to.length && block[0] !== 0 ? BAD : TORN; // zeros: the power was cut
        }
        const line = block.subarray(0, end);
        if (line.includes(0)) {
            return BAD;
        }
        to.set(line);
        this.at += end + 1;
        return end;
    }
}

/* The lines of a recording that grows: text is put in as it comes. */
export class FeedLines {
    constructor() {
        this.lines = [];
        this.rest = '';
        this.at = 0;
        this.steps = 0; // lines of steps that wait
        this.isOver = false;
        this.zeroUs = NaN; // time of the log at which the unit's clock is 0
        this.lastUs = 0;   // the same at which the last line of steps begins that came
    }

    put(text) {
        const lines = (this.rest + text).split('\n');
        this.rest = lines.pop().slice(0, LINE_MOST + 1);
        this.lines = this.lines.slice(this.at).concat(lines);
        this.at = 0;
        this.zeroUs = Number.isNaN(this.zeroUs) && lines.length > 0 ? timeOf(lines[0]) : this.zeroUs;
        const steps = lines.filter((line) => IS_STEPS.test(line));
        this.steps += steps.length;
        this.lastUs = steps.length > 0 ? timeOf(steps.at(-1)) : this.lastUs;
        this.isOver ||= lines.some((line) => IS_END.test(line));
    }

    /* What happened in a step is whole when the next line of steps is there. `left`: steps that are
     * left of the line read last. */
    isReady(left) {
        return this.isOver || left > 1 || this.steps >= (left === 1 ? 1 : 2);
    }

    next(to) {
        if (this.at === this.lines.length) {
            return OVER;
        }
        const line = this.lines[this.at++];
        this.steps -= IS_STEPS.test(line) ? 1 : 0;
        if (line.length > to.length || !/^[\x01-\x7e]*$/.test(line)) {
            return BAD;
        }
        for (let i = 0; i < line.length; i++) {
            to[i] = line.charCodeAt(i);
        }
        return line.length;
    }
}

/* Time of a line, in microseconds of its log; NaN: it has none. */
export function timeOf(line) {
    const m = /^\((\d{1,12})\.(\d{6})\)/.exec(line);
    return m ? Number(m[1]) * 1e6 + Number(m[2]) : NaN;
}

/* First and last time of a recording, of its first and last bytes. */
export function spanOf(source) {
    const text = (offset, length) => String.fromCharCode(...source.read(offset, length));
    const first = timeOf(text(0, Math.min(64, source.size)));
    const length = Math.min(4096, source.size), times = text(source.size - length, length).split('\n').map(timeOf);
    return [first, times.filter((us) => us >= first).at(-1) ?? first];
}

/* ---- replay ---- */

export class Replay extends Unit {
    static async load(moduleBytes, image) {
        const replay = new Replay();
        replay.image = image;
        replay.blocks = new Blocks(image, BLOCKS_KEPT);
        replay.hear = null; // called with each line that is read, as bytes
        replay.read = {offset: 0, to: 0, length: 0};
        await replay.start(moduleBytes, replay.flashImports(), (to, room) => replay.line(to >>> 0, room >>> 0));
        return replay;
    }

    flashImports() {
        return {
            start: (offset, to, length) => {
                this.read = {offset, to: to >>> 0, length: length >>> 0};
                return OK;
            },
            poll: () => {
                const {offset, to, length} = this.read;
                try {
                    this.blocks.copy(offset, new Uint8Array(this.calls.memory.buffer, to, length));
                    return OK;
                } catch {
                    return IO_ERROR;
                }
            },
        };
    }

    line(to, room) {
        const bytes = new Uint8Array(this.calls.memory.buffer, to, room);
        const length = this.lines.next(bytes);
        if (this.hear && length >= 0) {
            this.hear(bytes.subarray(0, length));
        }
        return length;
    }

    /* Begin. Throws where the recording cannot be flown with this module and image. */
    open(lines, isAny = false) {
        this.lines = lines;
        this.nowUs = 0;
        this.shown = 0;
        this.isOver = false;
        const status = this.calls.replay_open(this.image.size, isAny);
        if (status !== 0) {
            const cause = this.error(), isOther = cause.startsWith('another');
            throw new Error(isOther ? `the recording was made with ${cause}` : cause || `the unit does not start: status ${status}`);
        }
        [this.widthPx, this.heightPx] = [this.value('widthPx'), this.value('heightPx')];
    }

    /* True if the next step and what happened in it are there. */
    isReady() {
        return !this.isOver && this.lines.isReady(this.value('stepsRead'));
    }

    /* The next step. False at the end. */
    step() {
        const us = this.isOver ? -1 : this.calls.replay_step();
        this.isOver = us < 0;
        this.nowUs = this.isOver ? this.nowUs : us;
        return !this.isOver;
    }

    /* CRC-32C of the picture, as landmass-sim's tests have it. */
    checksum() {
        return this.calls.checksum() >>> 0;
    }

    error() {
        return this.text(this.calls.replay_error(), 256);
    }

    /* Why what is shown is not, or no longer, the flight that was recorded. */
    problem() {
        const [departures, checks, reads] = ['departures', 'checksFailed', 'readsDiffer'].map((name) => this.value(name));
        return this.error() || (departures + checks + reads === 0 ? ''
            : `not the flight recorded: departures ${departures}, checks of the glass failed ${checks}, reads that differ ${reads}`);
    }

    /* What else there is to know of the recording; '' if nothing. */
    remark() {
        const why = CEASED[this.value('ceased')];
        return [this.value('isOtherBuild') ? 'recorded by another build of this firmware' : '',
            why ? `the recorder gave up here: ${why}` : '',
            this.isOver && !why && !this.value('hasEnded') ? 'the recording has no end' : ''].filter(Boolean).join('; ');
    }

    /* ---- moments: the state of module and log, to go back to ---- */

    /* Go back, or on, to a moment of this recording, also one that another replay of it had. */
    restore({pages, at, us, pictures, isOver}) {
        const words = new Int32Array(this.calls.memory.buffer);
        pages.forEach((page, n) => unpack(page, words.subarray(n * PAGE, (n + 1) * PAGE)));
        [this.lines.at, this.nowUs, this.isOver, this.shown] = [at, us, isOver, pictures];
    }
}

/* ---- pages of memory ----
 *
 * null is all zero. Where few symbols occur, as in pictures, a page is {symbols, places}: up to 256
 * different words, or 128 different bytes, and for each its place among them, in as few bits as do.
 * Where little differs from an earlier page, it is {base, at, words}: that page and what differs.
 * Others are {words}. */

const PAGE = 16384; // words: 64 KiB
const WORDS_MOST = 256, BYTES_MOST = 128, DIFFERENT_MOST = 4096;

function areSame(a, b) {
    for (let i = 0; i < a.length; i++) {
        if (a[i] !== b[i]) {
            return false;
        }
    }
    return true;
}

const bitsFor = (symbols) => Math.ceil(Math.log2(symbols));

/* The symbols that occur, and the place of each among them; null: more than so many occur. */
function placesOf(all, most) {
    const places = new Map(), bytes = new Uint8Array(all.length);
    for (let i = 0, last = ~all[0], place = 0; i < all.length; i++) {
        if (all[i] !== last) {
            last = all[i];
            place = places.get(last) ?? places.size;
            if (place === most) {
                return null;
            }
            places.set(last, place);
        }
        bytes[i] = place;
    }
    return {symbols: all.constructor.from(places.keys()), places: squeeze(bytes, bitsFor(places.size))};
}

/* Numbers of so many bits, one after the other, the lowest bit first. */
function squeeze(numbers, bits) {
    const out = new Uint8Array(numbers.length * bits / 8);
    for (let i = 0, at = 0, held = 0, count = 0; i < numbers.length; i++) {
        held |= numbers[i] << count;
        for (count += bits; count >= 8; count -= 8, held >>= 8) {
            out[at++] = held;
        }
    }
    return out;
}

function unpackPlaces({symbols, places}, to) {
    const bits = bitsFor(symbols.length), mask = (1 << bits) - 1;
    for (let i = 0, at = 0, held = 0, count = 0; i < to.length; i++) {
        if (count < bits) {
            held |= places[at++] << count;
            count += 8;
        }
        to[i] = symbols[held & mask];
        held >>= bits;
        count -= bits;
    }
}

/* A page beside an earlier one; null: too much differs. */
function differenceOf(page, base) {
    const at = new Uint16Array(DIFFERENT_MOST);
    let count = 0;
    for (let i = 0; i < page.length; i++) {
        if (page[i] !== base.words[i]) {
            if (count === DIFFERENT_MOST) {
                return null;
            }
            at[count++] = i;
        }
    }
    return {base, at: at.slice(0, count), words: Int32Array.from({length: count}, (_, i) => page[at[i]])};
}

const bytesOf = (words) => new Uint8Array(words.buffer, words.byteOffset, words.byteLength);

function pack(page) {
    const packed = placesOf(page, WORDS_MOST) ?? placesOf(bytesOf(page), BYTES_MOST) ?? {words: page.slice()};
    return {...packed, size: (packed.words ?? packed.places).byteLength + (packed.symbols?.byteLength ?? 0)};
}

function unpack(page, to) {
    if (!page) {
        to.fill(0);
    } else if (page.symbols) {
        unpackPlaces(page, page.symbols instanceof Uint8Array ? bytesOf(to) : to);
    } else {
        to.set((page.base ?? page).words);
        page.at?.forEach((at, i) => { to[at] = page.words[i]; });
    }
}

function hashOf(page) {
    let hash = 0;
    for (let i = 0; i < page.length; i++) {
        hash = Math.imul(hash ^ page[i], 0x01000193);
    }
    return hash;
}

/* Moments of a flight within so many bytes: where they would take more, every second one goes, and
 * later ones are twice as far apart. Pages are shared where they are equal: with the moment before,
 * and, as those of the last pictures, within a moment. */
export class Moments {
    constructor(mostBytes, apartUs = 3e6) {
        this.mostBytes = mostBytes;
        this.apartUs = apartUs;
        this.all = [];
        this.mirror = null; // memory as of the moment kept last
        this.pages = [];    // of it
        this.bases = [];    // by place the last page that was kept word for word
        this.bytes = 0;
    }

    count() {
        const pages = new Set(this.bases), held = [...this.all.map((moment) => moment.pages), this.pages];
        held.forEach((all) => all.forEach((page) => pages.add(page).add(page?.base)));
        this.bytes = [...pages].reduce((sum, page) => sum + (page?.size ?? 0), this.mirror.byteLength);
    }

    /* A page of a place, as it is kept. */
    pack(page, n) {
        const difference = this.bases[n] ? differenceOf(page, this.bases[n]) : null;
        const packed = difference ? {...difference, size: difference.at.byteLength + difference.words.byteLength} : pack(page);
        if (!packed.symbols && !packed.base) {
            this.bases[n] = packed;
        }
        this.bytes += packed.size;
        return packed;
    }

    copy(words) {
        const seen = new Map(), part = (all, n) => all.subarray(n * PAGE, (n + 1) * PAGE);
        if (!this.mirror) {
            this.mirror = new Int32Array(words.length);
            this.bytes = this.mirror.byteLength;
        }
        this.pages = Array.from({length: words.length / PAGE}, (_, n) => {
            const page = part(words, n), before = part(this.mirror, n);
            if (areSame(page, before)) {
                return this.pages[n] ?? null;
            }
            before.set(page);
            const hash = hashOf(page), twin = seen.get(hash);
            const packed = twin && areSame(page, part(this.mirror, twin.n)) ? twin.packed : this.pack(page, n);
            seen.set(hash, {n, packed});
            return packed;
        });
        return this.pages;
    }

    /* Keep where a replay stands, if it is time for it. */
    keep(replay) {
        const last = this.all.at(-1);
        if (last && replay.nowUs < last.us + this.apartUs) {
            return;
        }
        this.all.push({pages: this.copy(new Int32Array(replay.calls.memory.buffer)), at: replay.lines.at, us: replay.nowUs,
            pictures: replay.value('pictures'), isOver: replay.isOver});
        while (this.all.length > 2 && this.bytes > this.mostBytes) {
            this.all = this.all.filter((_, n) => n % 2 === 0);
            this.apartUs *= 2;
            this.count();
        }
    }

    /* The last moment for which a test is true; the first at least. */
    last(isBefore) {
        return this.all.findLast(isBefore) ?? this.all[0];
    }
}

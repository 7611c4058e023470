/* The display unit: the module of WebAssembly, and what a page does with it. Runs in a page, a
 * worker, or node.
 *
 *     const unit = await Unit.load(moduleBytes, await httpSource('scene.lmdb'));
 *     await unit.open(768, 768);
 *     unit.frame(frame);               // {id, isExtended, data, timeUs}, of bus.mjs
 *     unit.step(nowUs);
 *     if (unit.hasNewPicture()) context.putImageData(new ImageData(unit.paint(), 768, 768), 0, 0); */
import {Flash} from './flash.mjs';

const OPEN_TRIES = 400;
const LINE_OVER = -1; // exports.h

/* enum web_value, in its order. */
const VALUES = ['pictures', 'flags', 'mode', 'fov', 'rangeNm', 'cursorLatitude', 'cursorLongitude',
    'isCursorPlaced', 'framesLost', 'actsLost', 'linesDropped', 'isRadarPage', 'isMapUsable', 'refused',
    'widthPx', 'heightPx', 'steps', 'stepsRead', 'departures', 'checks', 'checksFailed', 'readsDiffer', 'hasEnded',
    'isOtherBuild', 'ceased'];
export const MODES = ['GM', 'GMT', 'SEA', 'BCN', 'SAR'], FOVS = ['NORM', 'EXP', 'DBS1', 'DBS2'];
const DEGREES_OF_BAM = 360 / 2 ** 32;

export class Unit {
    static async load(moduleBytes, source) {
        const unit = new Unit();
        unit.flash = new Flash(source);
        await unit.start(moduleBytes, unit.flash.imports(() => unit.calls.memory), () => LINE_OVER);
        return unit;
    }

    /* `line` gives the lines of a recording (recording.mjs). */
    async start(moduleBytes, flash, line) {
        const {instance} = await WebAssembly.instantiate(moduleBytes, {flash, recording: {line}});
        this.calls = instance.exports;
    }

    /* Start the unit. What it reads at its start may still be on its way: it is started again until
     * everything was there. Throws if it cannot start, or if the image cannot be read or used. */
    async open(widthPx, heightPx) {
        this.widthPx = widthPx;
        this.heightPx = heightPx;
        this.shown = 0;
        for (let tries = 0; tries < OPEN_TRIES; tries++) {
            const {lateReads} = this.flash.count;
            const status = this.calls.open(this.flash.source.size, widthPx, heightPx);
            if (status !== 0) {
                throw new Error(`the unit does not start: status ${status}`);
            }
            await this.flash.settled();
            if (this.flash.failed.size > 0 || this.flash.count.lateReads === lateReads) {
                return this.judge();
            }
        }
        throw new Error(`${this.flash.source.name}: reads at the start never ended`);
    }

    judge() {
        if (this.flash.failed.size > 0) {
            throw new Error(`${this.flash.source.name}: the image cannot be read`);
        }
        if (!this.value('isMapUsable')) {
            throw new Error(`${this.flash.source.name}: no image that this display can use`);
        }
    }

    /* Hand over a frame. False if it was lost. */
    frame({id, isExtended, data, timeUs}) {
        const word = (at) => data.slice(at, at + 4).reduce((sum, byte, i) => sum + byte * 2 ** (8 * i), 0);
        return this.calls.frame(id, isExtended ? 1 : 0, data.length, word(0), word(4), timeUs) !== 0;
    }

    step(nowUs) {
        this.calls.step(nowUs);
    }

    value(name) {
        return this.calls.value(VALUES.indexOf(name));
    }

    hasNewPicture() {
        const pictures = this.value('pictures'), isNew = pictures !== this.shown;
        this.shown = pictures;
        return isNew;
    }

    /* Four bytes a pixel, red first: a view of the module's memory, valid until the next step. */
    paint() {
        const at = this.calls.paint();
        return new Uint8ClampedArray(this.calls.memory.buffer, at, this.widthPx * this.heightPx * 4);
    }

    /* The words of the flags that are up, as the glass shows them. */
    warnings() {
        const flags = this.value('flags'), words = [];
        for (let n = 0; n < 32; n++) {
            const at = flags >>> n & 1 ? this.calls.flag_word(n) : 0;
            if (at) {
                words.push(this.text(at, 16));
            }
        }
        return words;
    }

    /* Characters of the module's memory up to a zero byte. */
    text(at, most) {
        const bytes = new Uint8Array(this.calls.memory.buffer, at, most);
        return String.fromCharCode(...bytes.subarray(0, bytes.indexOf(0)));
    }

    /* What the glass shows, in a sentence. */
    describe() {
        const mode = MODES[this.value('mode')], fov = FOVS[this.value('fov')];
        const parts = [mode === 'SAR' ? 'SAR patch' : `${mode} ${fov}, ${this.value('rangeNm')} NM`];
        if (this.value('isCursorPlaced')) {
            const latitude = (this.value('cursorLatitude') | 0) * DEGREES_OF_BAM;
            const longitude = (this.value('cursorLongitude') | 0) * DEGREES_OF_BAM;
            parts.push(`cursor ${latitude.toFixed(4)} ${longitude.toFixed(4)}`);
        }
        const warnings = this.warnings();
        return parts.concat(warnings.length ? `warnings: ${warnings.join(', ')}` : []).join('; ');
    }

    /* Draw a patch around a place, in degrees, with cells of so many metres. */
    patch(latitude, longitude, cellM) {
        const bam = (degrees) => Math.round(degrees / DEGREES_OF_BAM) >>> 0;
        this.calls.patch(bam(latitude), bam(longitude), Math.round(1000 * cellM));
    }
}

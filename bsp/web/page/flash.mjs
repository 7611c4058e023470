/* Flash: the database image, read by blocks of 64 KiB as they are needed and never whole.
 *
 * A source is {name, size, read(offset, length)}: read returns a promise of a Uint8Array of that
 * length, or throws. The cache holds the blocks used last. A read of the firmware is answered at
 * once where its blocks are there; otherwise it is busy until they have come, and fails when one of
 * them cannot be had, as on any flash. */

export const BLOCK = 65536;
const BLOCKS_KEPT = 256; // 16 MiB

const OK = 0, BUSY = 1, IO_ERROR = -1; // lm/status.h
const RETRIES = 2;

/* An image file of a web server, by ranges of bytes. Throws where the server has no such file or no
 * ranges: the whole image is never read. */
export async function httpSource(url) {
    const probe = await fetch(url, {headers: {Range: 'bytes=0-0'}});
    const range = /^bytes 0-0\/(\d+)$/.exec(probe.headers.get('Content-Range') ?? '');
    await probe.body?.cancel();
    if (!probe.ok) {
        throw new Error(`${url}: the server answers ${probe.status}`);
    }
    if (probe.status !== 206 || !range) {
        throw new Error(`${url}: the server does not serve ranges of bytes; one that does is serve.mjs`);
    }
    const read = async (offset, length) => {
        const answer = await fetch(url, {headers: {Range: `bytes=${offset}-${offset + length - 1}`}});
        const bytes = new Uint8Array(await answer.arrayBuffer());
        if (answer.status !== 206 || bytes.length !== length) {
            throw new Error(`${url}: ${bytes.length} bytes with status ${answer.status} instead of ${length}`);
        }
        return bytes;
    };
    return {name: url, size: Number(range[1]), read};
}

/* A file that was dropped on the page. */
export function fileSource(file) {
    const read = async (offset, length) =>
        new Uint8Array(await file.slice(offset, offset + length).arrayBuffer());
    return {name: file.name, size: file.size, read};
}

export class Flash {
    constructor(source) {
        this.source = source;
        this.blocks = new Map(); // in the order of their last use
        this.coming = new Map(); // number of a block to the promise of its arrival
        this.failed = new Set();
        this.pending = null;     // the read under way: {offset, to, length}
        this.count = {blocks: 0, bytes: 0, failures: 0, lateReads: 0};
    }

    /* Imports of the module; `memory` is a function that returns the module's memory as it is now. */
    imports(memory) {
        return {
            start: (offset, to, length) => {
                this.pending = {offset, to: to >>> 0, length: length >>> 0};
                this.failed.clear();
                this.count.lateReads += this.fetchMissing() ? 0 : 1;
                return OK;
            },
            poll: () => this.finish(memory()),
        };
    }

    /* Numbers of the blocks that the read under way touches. */
    wanted() {
        const {offset, length} = this.pending;
        const first = Math.floor(offset / BLOCK), end = Math.ceil((offset + length) / BLOCK);
        return Array.from({length: Math.max(end - first, 0)}, (_, i) => first + i);
    }

    /* Ask for the blocks that are not there. True if none is missing. */
    fetchMissing() {
        const missing = this.wanted().filter((n) => !this.blocks.has(n));
        missing.filter((n) => !this.coming.has(n) && !this.failed.has(n)).forEach((n) => {
            this.coming.set(n, this.fetchBlock(n).finally(() => this.coming.delete(n)));
        });
        return missing.length === 0;
    }

    async fetchBlock(n) {
        const offset = n * BLOCK, length = Math.min(BLOCK, this.source.size - offset);
        for (let tries = 0; tries <= RETRIES; tries++) {
            try {
                this.keep(n, await this.source.read(offset, length));
                return;
            } catch {
                this.count.failures++;
            }
        }
        this.failed.add(n);
    }

    keep(n, bytes) {
        this.blocks.set(n, bytes);
        this.count.blocks++;
        this.count.bytes += bytes.length;
        while (this.blocks.size > BLOCKS_KEPT) {
            this.blocks.delete(this.blocks.keys().next().value);
        }
    }

    /* Answer a poll: copy, if every block is there. */
    finish(memory) {
        const numbers = this.wanted();
        if (numbers.some((n) => this.failed.has(n))) {
            return IO_ERROR;
        }
        if (!this.fetchMissing()) {
            return BUSY;
        }
        const {offset, to, length} = this.pending;
        for (const n of numbers) {
            const block = this.blocks.get(n), start = n * BLOCK;
            this.blocks.delete(n);
            this.blocks.set(n, block);
            const from = Math.max(offset, start), end = Math.min(offset + length, start + BLOCK);
            new Uint8Array(memory.buffer, to + from - offset, end - from)
                .set(block.subarray(from - start, end - start));
        }
        return OK;
    }

    /* Resolves when nothing is under way. */
    async settled() {
        while (this.coming.size > 0) {
            await Promise.all(this.coming.values());
        }
    }
}

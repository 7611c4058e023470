/* The page: a clock, a bus, a unit and a canvas. Everything that the display does, it does in the
 * module; everything that moves it comes from here. */
import {hold, makeBezel} from './bezel.mjs';
import {LogBus, SocketBus} from './bus.mjs';
import {fileSource, httpSource} from './flash.mjs';
import {Flight} from './flight.mjs';
import {gamepadActs} from './gamepad.mjs';
import {listen} from './keyboard.mjs';
import {calmly, Player} from './player.mjs';
import {Tour} from './tour.mjs';
import {Unit} from './unit.mjs';

const SIDE = 768, STEP_US = 4000, BEHIND_MOST_US = 100000, TAP_MS = 60, CALM_MS = 1000;
const FULL = 1000; // LM_FULL_DEFLECTION
const START = {latitude: 42.045, longitude: -29.18, headingDeg: 90, heightM: 3000, speedMs: 180};

const IS_RECORDING = /^\(\d+\.\d{6}\) unit 1F4C4D00#/; // docs/FORMATS.md, 2.8

const find = (id) => document.getElementById(id);
const wait = (ms) => new Promise((done) => setTimeout(done, ms));

class Page {
    async start() {
        this.context = find('glass').getContext('2d', {alpha: false});
        this.moduleBytes = await (await fetch('landmass.wasm')).arrayBuffer();
        this.hands = makeBezel(find('bezel'), (isDown, number) => this.unit?.calls.button(isDown, number));
        this.calm = matchMedia('(prefers-reduced-motion: reduce)'); // then the glass is drawn once a second
        this.paintedMs = -Infinity;
        this.deflection = [0, 0];
        this.knob = 0;
        this.byHand();
        this.connectControls();
        this.image = {url: new URL('scene.lmdb', document.baseURI).href};
        await this.open(await httpSource(this.image.url));
        this.tour = new Tour(this, (text, hasBack) => {
            find('tour-text').textContent = text;
            find('tour-back').disabled = !hasBack;
        });
        requestAnimationFrame((ms) => this.frame(ms));
    }

    /* Fly over another image. The one before stays if this one cannot be used. */
    async open(source) {
        const unit = await Unit.load(this.moduleBytes, source);
        await unit.open(SIDE, SIDE);
        this.unit = unit;
        this.nowUs = 0;
        this.begunMs = null;
        this.figures = {steps: 0, stepMs: 0, worstMs: 0, pictures: 0, since: performance.now()};
        if (this.bus instanceof LogBus) {
            this.bus.next = this.bus.lapUs = 0;
        }
        if (this.bus instanceof Flight) {
            this.bus.nextUs = null;
        }
    }

    setBus(bus) {
        this.endReplay();
        this.bus?.close?.();
        this.bus = bus;
        if (bus instanceof LogBus) {
            bus.lapUs = this.nowUs ?? 0;
        }
    }

    byHand() {
        this.setBus(new Flight(START));
    }

    /* Steps up to the time of this frame. What a hidden tab missed is left out. */
    frame(ms) {
        requestAnimationFrame((next) => this.frame(next));
        if (this.player) {
            this.begunMs = null; // this page's own flight stands still
            return;
        }
        const isPaused = find('pause').getAttribute('aria-pressed') === 'true';
        this.begunMs ??= ms - this.nowUs / 1000;
        if (isPaused || (ms - this.begunMs) * 1000 - this.nowUs > BEHIND_MOST_US) {
            this.begunMs = ms - (this.nowUs + (isPaused ? 0 : STEP_US)) / 1000;
        }
        gamepadActs(this);
        while (!isPaused && this.nowUs + STEP_US <= (ms - this.begunMs) * 1000) {
            this.step();
        }
        if (ms - this.paintedMs >= (this.calm.matches ? CALM_MS : 0) && this.unit.hasNewPicture()) {
            this.paintedMs = ms;
            this.context.putImageData(new ImageData(this.unit.paint(), SIDE, SIDE), 0, 0);
            this.figures.pictures++;
            this.firstPictureMs ??= performance.now(); // since the page was asked for
        }
        this.tell();
    }

    step() {
        const before = performance.now();
        this.nowUs += STEP_US;
        this.bus.deliver(this.unit, this.nowUs);
        this.unit.step(this.nowUs);
        const took = performance.now() - before;
        this.figures.steps++;
        this.figures.stepMs += took;
        this.figures.worstMs = Math.max(this.figures.worstMs, took);
    }

    /* Once a second: figures, and what the glass shows in words. */
    tell() {
        const f = this.figures, ms = performance.now() - f.since;
        if (ms < 1000) {
            return;
        }
        const {bytes, failures} = this.unit.flash.count;
        find('figures').textContent = `${(f.pictures * 1000 / ms).toFixed(0)} pictures a second; a step takes `
            + `${(f.stepMs / Math.max(f.steps, 1)).toFixed(2)} ms, ${f.worstMs.toFixed(1)} at worst; `
            + `${(bytes / 1e6).toFixed(1)} MB of ${(this.unit.flash.source.size / 1e6).toFixed(1)} read`
            + (failures ? `, ${failures} reads failed` : '')
            + (this.firstPictureMs ? `; the first picture came after ${(this.firstPictureMs / 1000).toFixed(1)} s` : '');
        find('description').textContent = this.unit.describe();
        find('flight-state').textContent = this.bus instanceof Flight ? this.bus.describe() : 'The bus flies.';
        this.figures = {steps: 0, stepMs: 0, worstMs: 0, pictures: 0, since: performance.now()};
    }

    say(text) {
        find('message').textContent = text;
    }

    /* ---- acts ---- */

    slew(x, y) {
        this.deflection = [this.deflection[0] + x, this.deflection[1] + y];
        this.unit.calls.slew(...this.deflection.map((d) => FULL * Math.sign(d)));
    }

    turnKnob(deflection) {
        this.knob = Math.min(Math.max(deflection, -FULL), FULL);
        find('knob').value = this.knob;
        this.unit.calls.knob(this.knob);
    }

    patch(latitude, longitude, cellM) {
        this.unit.patch(latitude, longitude, cellM);
    }

    async tap(number) {
        this.hands[number].down();
        await wait(TAP_MS);
        this.hands[number].up();
        await wait(TAP_MS);
    }

    fly(what) {
        const acts = {left: (f) => f.turn(-5), right: (f) => f.turn(5), up: (f) => f.climb(5), down: (f) => f.climb(-5),
            faster: (f) => f.faster(10), slower: (f) => f.faster(-10), level: (f) => f.level()};
        if (this.bus instanceof Flight) {
            acts[what](this.bus);
        }
    }

    togglePause() {
        const isPaused = find('pause').getAttribute('aria-pressed') === 'true';
        find('pause').setAttribute('aria-pressed', String(!isPaused));
        this.player?.play(isPaused ? 1 : 0);
    }

    connectControls() {
        document.querySelectorAll('[data-fly]').forEach((b) => b.addEventListener('click', () => this.fly(b.dataset.fly)));
        document.querySelectorAll('[data-slew]').forEach((b) => {
            const [x, y] = b.dataset.slew.split(',').map(Number);
            hold(b, () => this.slew(x, y), () => this.slew(-x, -y));
        });
        const clicks = {designate: () => this.unit.calls.designate(), drop: () => this.unit.calls.drop(),
            pause: () => this.togglePause(), 'by-hand': () => this.byHand(), recorded: () => this.flyRecorded(), connect: () => this.connect(),
            'tour-next': () => this.tour.next(), 'tour-back': () => this.tour.back()};
        Object.entries(clicks).forEach(([id, act]) => find(id).addEventListener('click', act));
        find('knob').addEventListener('input', () => this.turnKnob(Number(find('knob').value)));
        find('log').addEventListener('change', () => this.takeFile(find('log').files[0], false));
        find('image').addEventListener('change', () => this.takeFile(find('image').files[0], true));
        document.addEventListener('dragover', (event) => event.preventDefault());
        document.addEventListener('drop', (event) => {
            event.preventDefault();
            const file = event.dataTransfer.files[0];
            this.takeFile(file, file?.name.endsWith('.lmdb'));
        });
        const keys = {KeyJ: 'left', KeyL: 'right', KeyI: 'up', KeyK: 'down', KeyO: 'faster', KeyU: 'slower', KeyM: 'level'};
        const press = {Enter: clicks.designate, Backspace: clicks.drop, KeyP: clicks.pause,
            PageUp: () => this.turnKnob(this.knob + 100), PageDown: () => this.turnKnob(this.knob - 100)};
        Object.entries(keys).forEach(([code, what]) => { press[code] = () => this.fly(what); });
        listen(this.hands, (x, y) => this.slew(x, y), press);
    }

    /* ---- other flights and places ---- */

    async takeFile(file, isImage) {
        if (!file) {
            return;
        }
        try {
            if (isImage) {
                this.endReplay();
                await this.open(fileSource(file));
                this.image = {file};
            } else if (IS_RECORDING.test(await file.slice(0, 100).text())) {
                this.replay(file);
                return;
            } else {
                this.setBus(new LogBus(await file.text()));
            }
            const refused = isImage ? 0 : this.bus.refused;
            this.say(refused ? `${file.name}: ${refused} lines that are no data frame were left out` : '');
        } catch (error) {
            this.say(`${file.name}: ${error.message}`);
        }
    }

    /* The flight that lies beside the page. */
    async flyRecorded() {
        const answer = await fetch('flight.log').catch(({message}) => ({ok: false, status: message}));
        if (answer.ok) {
            this.setBus(new LogBus(await answer.text()));
        }
        this.say(answer.ok ? '' : `flight.log: the server answers ${answer.status}`);
    }

    /* A recording has its own bus, keys and clock: the unit that flew stands still meanwhile. */
    replay(file) {
        this.endReplay();
        find('pause').setAttribute('aria-pressed', 'false');
        this.say('');
        this.player = new Player(find('glass'), {
            isWanted: calmly(),
            onOpened: () => this.player.play(1),
            onState: ({us, words, remark, problem, isOver}) => {
                find('description').textContent = [words, remark].filter(Boolean).join('; ');
                find('flight-state').textContent = `${file.name}, ${(us / 1e6).toFixed(0)} s${isOver ? ': the end' : ''}`;
                this.say(problem ? `${file.name}: ${problem}` : '');
            },
            onError: (text) => {
                this.endReplay();
                this.say(`${file.name}: ${text}`);
            },
        });
        this.player.open(this.moduleBytes, this.image, {file});
    }

    endReplay() {
        this.player?.close();
        this.player = null;
        if (find('glass').width !== SIDE || find('glass').height !== SIDE) {
            Object.assign(find('glass'), {width: SIDE, height: SIDE});
        }
    }

    connect() {
        const url = find('socket').value.trim();
        try {
            this.setBus(new SocketBus(url, (state) => this.say(`live bus ${url}: ${state}`)));
        } catch (error) {
            this.say(`${url || 'no address'}: ${error.message}`);
        }
    }
}

const page = new Page();
globalThis.landmass = page; // for tests, and for whoever opens the browser's console
page.start().catch((error) => page.say(error.message));

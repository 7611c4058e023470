/* Repeater of a display: the display's firmware, fed with what the panel records, shows the panel's
 * picture at the same step. Where the panel records nothing, it is fed with the bus alone: then it
 * is a display of the same bus, and the page says so.
 *
 * A picture that is not fresh must not look alive: whatever stops or lags is said over it. */
import {SocketBus} from './web/bus.mjs';
import {httpSource} from './web/flash.mjs';
import {calmly, Player} from './web/player.mjs';
import {Unit} from './web/unit.mjs';

const SILENT_MS = 1000, LATE_US = 700000, CHECK_MS = 200, AGAIN_MS = 2000, NEXT_MS = 15000;
const SIDE = 768, STEP_US = 4000, BEHIND_MOST_US = 100000;

const find = (id) => document.getElementById(id);

/* What has to be said over the picture; '' where it is fresh. */
export function trouble({isUp, silentMs, behindUs, lateUs, isOver, problem}) {
    const seconds = (us) => `${(us / 1e6).toFixed(1)} s`;
    return problem ? `NOT THE DISPLAY'S PICTURE: ${problem}`
        : isOver ? 'THE DISPLAY HAS STOPPED'
            : !isUp ? 'NOT CONNECTED'
                : silentMs > SILENT_MS ? `STOPPED ${seconds(silentMs * 1000)} AGO`
                    : behindUs > LATE_US ? `CATCHING UP: ${seconds(behindUs)} BEHIND`
                        : lateUs > LATE_US ? `LATE: ${seconds(lateUs)}` : '';
}

class Repeater {
    async start() {
        this.isWanted = calmly();
        this.module = await (await fetch('web/landmass.wasm')).arrayBuffer();
        this.image = new URL('image', document.baseURI).href;
        const station = await (await fetch('station.json')).json();
        this.displays = station.displays;
        find('display').replaceChildren(...this.displays.map(({name}) => new Option(name, name)));
        find('display').addEventListener('change', () => this.choose(find('display').value));
        const wanted = new URLSearchParams(location.search).get('display');
        this.choose(this.displays.find(({name}) => name === wanted)?.name ?? this.displays[0]?.name);
        setInterval(() => this.judge(), CHECK_MS);
    }

    say(text) {
        find('message').textContent = text;
    }

    socketUrl(path) {
        return new URL(path, document.baseURI).href.replace(/^http/, 'ws');
    }

    choose(name) {
        this.stop();
        const display = this.displays.find((d) => d.name === name);
        if (!display) {
            this.say('The station has no displays.');
            return;
        }
        find('display').value = name;
        this.display = display;
        this.pictures = 0;
        if (display.recording) {
            this.follow();
        } else {
            this.followBus().catch((error) => this.say(error.message));
        }
    }

    stop() {
        clearTimeout(this.again);
        this.again = 0;
        this.player?.close();
        this.bus?.close();
        this.player = this.bus = this.unit = null;
        this.state = {isUp: false};
        this.heardMs = performance.now();
        find('note').textContent = '';
        this.judge();
    }

    /* ---- the panel's recording ---- */

    follow() {
        const url = this.socketUrl(`display/${encodeURIComponent(this.display.name)}`);
        this.player = new Player(find('glass'), {
            onState: (state) => this.take(state),
            onLink: ({isUp}) => this.link(isUp),
            onPicture: (picture) => this.pictured(picture),
            onError: (text) => this.fail(text),
            isWanted: this.isWanted,
        });
        this.player.follow(this.module, {url: this.image}, url, ['landmass-recording']);
    }

    take(state) {
        this.heardMs = performance.now();
        this.state = {...this.state, ...state};
        find('words').textContent = [state.words, state.remark].filter(Boolean).join('; ');
        this.judge();
        if (state.isOver && !this.again) {
            this.later(NEXT_MS); // the display may have begun another recording
        }
    }

    link(isUp) {
        this.state.isUp = isUp;
        this.judge();
        if (!isUp) {
            this.later();
        }
    }

    fail(text) {
        this.say(`${this.display.name}: ${text}`);
        this.state = {isUp: false};
        this.judge();
        this.later();
    }

    later(ms = AGAIN_MS) {
        clearTimeout(this.again);
        this.again = setTimeout(() => this.choose(this.display.name), ms);
    }

    pictured(picture) {
        this.pictures++;
        this.last = picture;
        this.onPicture?.(picture);
    }

    /* Say over the picture what is wrong with it, also when the worker is silent. */
    judge() {
        const unheardMs = performance.now() - this.heardMs;
        const silentMs = Math.max(this.state.silentMs ?? 0, unheardMs > SILENT_MS ? unheardMs : 0);
        const text = trouble({...this.state, silentMs: this.player || this.bus ? silentMs : 0});
        if (find('over').textContent !== text) {
            find('over').textContent = text;
        }
        find('frame').classList.toggle('stale', text !== '');
        find('figures').textContent = typeof this.state.behindUs !== 'number' ? '' : `${this.pictures} pictures; `
            + `${(this.state.behindUs / 1000).toFixed(0)} ms behind what has come; it comes ${(this.state.lateUs / 1000).toFixed(0)} ms `
            + 'later than at best';
    }

    /* ---- the bus alone ---- */

    async followBus() {
        find('note').textContent = 'From the bus alone: not step-exact. The keys of the panel are not known.';
        const {display} = this, unit = await Unit.load(this.module, await httpSource(this.image)), context = find('glass').getContext('2d', {alpha: false});
        Object.assign(find('glass'), {width: SIDE, height: SIDE});
        await unit.open(SIDE, SIDE);
        if (this.display !== display) {
            return; // another one was chosen meanwhile
        }
        const bus = new SocketBus(this.socketUrl('bus'), (state) => this.link(state === 'connected'), 'landmass-bus');
        Object.assign(this, {unit, bus});
        let nowUs = 0, begunMs = performance.now();
        const frame = (ms) => {
            if (this.bus !== bus) {
                return;
            }
            requestAnimationFrame(frame);
            if ((ms - begunMs) * 1000 - nowUs > BEHIND_MOST_US) {
                begunMs = ms - (nowUs + STEP_US) / 1000;
            }
            for (; nowUs + STEP_US <= (ms - begunMs) * 1000; nowUs += STEP_US) {
                this.heardMs = bus.waiting.length > 0 ? performance.now() : this.heardMs;
                bus.deliver(unit, nowUs + STEP_US);
                unit.step(nowUs + STEP_US);
            }
            if (unit.hasNewPicture() && this.isWanted()) {
                context.putImageData(new ImageData(unit.paint(), SIDE, SIDE), 0, 0);
                this.pictures++;
            }
        };
        requestAnimationFrame(frame);
    }
}

const repeater = new Repeater();
globalThis.repeater = repeater; // for tests, and for whoever opens the browser's console
repeater.start().catch((error) => repeater.say(error.message));

/* A player of recordings on a canvas. The work is done in a worker (replay_worker.mjs).
 *
 *     const player = new Player(canvas, {onState, onError, onPicture, onLink, onOpened});
 *     player.open(moduleBytes, {url: 'scene.lmdb'}, {file});     image and recording: a file or an address;
 *                                                                of a recording in parts a list of them
 *     player.play(1); player.pause(); player.toTime(us); player.byPictures(-1);
 *     player.follow(moduleBytes, {url: '/image'}, 'ws://...');   a recording that grows
 *
 * isWanted() says of each picture that comes whether it is drawn; calmly() makes one. */
const CALM_MS = 1000;

/* A picture a second where the system asks for less motion, every one elsewhere. */
export function calmly() {
    const calm = matchMedia('(prefers-reduced-motion: reduce)');
    let drawnMs = -Infinity;
    return () => {
        const now = performance.now(), isTime = !calm.matches || now - drawnMs >= CALM_MS;
        drawnMs = isTime ? now : drawnMs;
        return isTime;
    };
}

export class Player {
    constructor(canvas, {onState = () => {}, onError = () => {}, onPicture = () => {}, onLink = () => {}, onOpened = () => {},
        isWanted = () => true} = {}) {
        this.canvas = canvas;
        this.context = canvas.getContext('2d', {alpha: false});
        this.speed = 0;
        this.isWanted = isWanted;
        this.worker = new Worker(new URL('replay_worker.mjs', import.meta.url), {type: 'module'});
        const says = {state: onState, error: ({text}) => onError(text), link: onLink, opened: onOpened,
            picture: (picture) => onPicture(this.draw(picture))};
        this.worker.onmessage = ({data}) => says[data.say](data);
        this.worker.onerror = (event) => onError(event.message ?? 'the worker of the player does not start');
    }

    draw(picture) {
        const {pixels, widthPx, heightPx} = picture;
        this.us = picture.us;
        if (!this.isWanted()) {
            return picture;
        }
        if (this.canvas.width !== widthPx || this.canvas.height !== heightPx) {
            Object.assign(this.canvas, {width: widthPx, height: heightPx});
        }
        if (picture.picture === 0) { // before the display's first one
            this.context.fillRect(0, 0, widthPx, heightPx);
            return picture;
        }
        this.context.putImageData(new ImageData(new Uint8ClampedArray(pixels), widthPx, heightPx), 0, 0);
        return picture;
    }

    ask(what, rest = {}) {
        this.worker.postMessage({ask: what, ...rest});
    }

    open(module, image, log, isAny = false) {
        this.ask('open', {module, image, log, isAny});
    }

    follow(module, image, url, protocol = []) {
        this.ask('follow', {module, image, url, protocol});
    }

    /* Times real time; below 0 backwards, from one moment that is kept to the one before. */
    play(speed) {
        this.speed = speed;
        this.ask('play', {speed});
    }

    pause() {
        this.play(0);
    }

    toTime(us) {
        this.ask('time', {us});
    }

    byPictures(by) {
        this.speed = 0;
        this.ask('picture', {by});
    }

    close() {
        this.worker.terminate();
    }
}

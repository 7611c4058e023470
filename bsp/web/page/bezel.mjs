/* The bezel: 20 option select buttons around the glass and a rocker in each corner, as buttons of
 * the page. Mouse, touch and keyboard hold them down; the firmware knows which of them repeat. */

const ROCKERS = ['GAIN', 'SYM', 'BRT', 'CON']; // enum lm_rocker
const MARGIN = 10;                             // per cent of the bezel, on each side of the glass
const KEY = 6, ROCKER = [7, 4.6];              // sizes, per cent
const ROCKER_AT = 2.6, ROCKER_APART = 6.4;     // so far that a finger meets one of the two

/* Middle of button 1..28, per cent of the bezel from left and top. */
function middleOf(number) {
    if (number > 20) {
        const rocker = Math.floor((number - 21) / 2), isLess = (number - 21) % 2;
        const isRight = rocker === 1 || rocker === 2, isLow = rocker >= 2;
        const top = isLow ? 100 - ROCKER_AT - ROCKER_APART : ROCKER_AT;
        return [isRight ? 100 - MARGIN / 2 : MARGIN / 2, top + isLess * ROCKER_APART];
    }
    const side = Math.floor((number - 1) / 5), along = (number - 1) % 5;
    const at = 50 + ((side < 2 ? along : 4 - along) - 2) * 0.15 * (100 - 2 * MARGIN);
    return [[at, MARGIN / 2], [100 - MARGIN / 2, at], [at, 100 - MARGIN / 2], [MARGIN / 2, at]][side];
}

function labelOf(number) {
    if (number <= 20) {
        return [String(number), `key ${number}`];
    }
    const name = ROCKERS[Math.floor((number - 21) / 2)], isMore = number % 2 === 1;
    return [name + (isMore ? '+' : '-'), `${name} ${isMore ? 'more' : 'less'}`];
}

/* Call onDown and onUp while an element is held, by pointer or by Enter and Space. */
export function hold(element, onDown, onUp) {
    let isDown = false;
    const down = () => {
        if (!isDown) {
            isDown = true;
            element.classList.add('down');
            onDown();
        }
    };
    const up = () => {
        if (isDown) {
            isDown = false;
            element.classList.remove('down');
            onUp();
        }
    };
    const isKey = (event) => event.key === 'Enter' || event.key === ' ';
    element.addEventListener('pointerdown', (event) => {
        if (event.button === 0) {
            element.setPointerCapture(event.pointerId);
            down();
        }
    });
    ['pointerup', 'pointercancel', 'lostpointercapture', 'blur'].forEach((name) => element.addEventListener(name, up));
    element.addEventListener('keydown', (event) => {
        if (isKey(event)) {
            event.preventDefault();
            event.stopPropagation();
            down();
        }
    });
    element.addEventListener('keyup', (event) => isKey(event) && up());
    return {down, up};
}

/* Add the buttons to the bezel. `act(isDown, number)` is told of each. Returns, by number, what
 * holds a button for another hand: {down, up}. */
export function makeBezel(bezel, act) {
    const hands = [];
    for (let number = 1; number <= 28; number++) {
        const button = document.createElement('button');
        const [words, name] = labelOf(number), [x, y] = middleOf(number);
        const [width, height] = number > 20 ? ROCKER : [KEY, KEY];
        button.type = 'button';
        button.textContent = words;
        button.dataset.button = number;
        button.setAttribute('aria-label', name);
        Object.assign(button.style, {left: `${x - width / 2}%`, top: `${y - height / 2}%`,
            width: `${width}%`, height: `${height}%`});
        bezel.append(button);
        hands[number] = hold(button, () => act(true, number), () => act(false, number));
    }
    return hands;
}

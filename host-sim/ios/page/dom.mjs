/* Small helpers for the page's elements. Text is only written where it changed, and rows keep their
 * elements, so that nothing loses the keyboard's focus. */

export const find = (id) => document.getElementById(id);

export function say(element, text) {
    if (element.textContent !== text) {
        element.textContent = text;
    }
}

export function make(tag, words = {}, ...children) {
    const element = document.createElement(tag);
    const {text = null, on = {}, data = {}, ...attributes} = words;
    Object.entries(attributes).forEach(([name, value]) => element.setAttribute(name, value));
    Object.entries(on).forEach(([name, act]) => element.addEventListener(name, act));
    Object.assign(element.dataset, data);
    if (text !== null) {
        element.textContent = text;
    }
    element.append(...children);
    return element;
}

export const button = (text, act, more = {}) => make('button', {type: 'button', text, on: {click: act}, ...more});

/* A number of an input; null where it is empty, NaN where it is outside the input's own limits. */
export function numberOf(input) {
    if (input.value.trim() === '' && input.validity.valid) {
        return null;
    }
    const value = Number(input.value);
    return input.validity.valid && Number.isFinite(value) ? value : NaN;
}

/* What an input takes, in words. */
export const limits = (input) => `${input.labels[0].firstChild.textContent.trim()}: ${input.min} to ${input.max}`;

/* One element of `body` for each item, in order: `create(key)` makes it, `update(element, item)` fills it. */
export function rows(body, items, create, update) {
    const held = new Map([...body.children].map((element) => [element.dataset.key, element]));
    items.forEach((item, at) => {
        const key = String(item.key), element = held.get(key) ?? create(item);
        element.dataset.key = key;
        held.delete(key);
        if (body.children[at] !== element) {
            body.insertBefore(element, body.children[at] ?? null);
        }
        update(element, item);
    });
    held.forEach((element) => element.remove());
}

/* Give the user a file. What it is: {name, bytes, type}. */
export function saveAs(name, blob) {
    const link = make('a', {href: URL.createObjectURL(blob), download: name});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    return {name, bytes: blob.size, type: blob.type};
}

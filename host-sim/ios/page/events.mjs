/* The list of events as a file: comma-separated values, as RFC 4180 has them. */
import {clockWords} from './geo.mjs';

const fieldOf = (text) => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/* A line for each event: time of the bus (UTC), exercise's time where there is one, what changed, and
 * who did it. */
export function csvOf(events) {
    const lines = events.map(({busUs, exerciseMs, text, by}) => [new Date(busUs / 1000).toISOString(),
        exerciseMs === null ? '' : clockWords(exerciseMs), text, by === 'nobody' ? '' : by]);
    return [['utc', 'exercise', 'event', 'by'], ...lines].map((line) => `${line.map(fieldOf).join(',')}\r\n`).join('');
}

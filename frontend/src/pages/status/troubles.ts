import type { Status } from "../../api/status_endpoints";
import { formatBytes, formatDuration, sentence } from "../../design/format";

const LITTLE_FREE = 2e9; // bytes
const LONG_WAIT = 600; // s

/** What somebody should look at, in sentences; empty where all is well. */
export function troublesOf({ crew, dispatcher, disks, queue }: Status): string[] {
  const troubles: string[] = [];
  if (!crew.reachable) troubles.push(sentence(crew.problem ?? "Work can't be sent to the workers"));
  if (dispatcher.held === false) troubles.push("No server gives work out: what waits will go on waiting.");
  for (const { name, address, accepted, reason } of crew.workers) {
    if (!accepted)
      troubles.push(sentence(`The worker ${name} at ${address} gets no work: ${reason ?? "unknown"}`));
  }
  for (const { name, free, problem } of disks) {
    if (problem) troubles.push(sentence(`The store of ${name} can't be reached: ${problem}`));
    else if (free !== null && free < LITTLE_FREE) {
      troubles.push(`Only ${formatBytes(free)} are free where the ${name} lie.`);
    }
  }
  for (const { kind, running, oldest_wait } of queue) {
    if (running === 0 && oldest_wait !== null && oldest_wait > LONG_WAIT) {
      troubles.push(
        `Nothing of the ${kind} runs, and the oldest has waited for ${formatDuration(oldest_wait)}.`,
      );
    }
  }
  return troubles;
}

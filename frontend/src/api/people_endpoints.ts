/** Calls about who has an image open. */

import { apiUrl, client, unwrap } from "./client";
import { personHeaders } from "./person";
import type { components } from "./schema";

type Schemas = components["schemas"];
/** Who has an image open, and who of them holds it. */
export type LeaseState = Schemas["LeaseAnswer"];
export type Present = Schemas["Present"];

export const putLease = (image_id: number, client_id: string, take_over: boolean): Promise<LeaseState> =>
  unwrap(
    client.PUT("/api/images/{image_id}/lease", {
      params: { path: { image_id } },
      body: { client_id, take_over },
    }),
  );

/** Says that a page has left an image; the request outlives the page. */
export function dropLease(imageId: number, clientId: string): void {
  fetch(apiUrl(`/images/${imageId}/lease`, { client_id: clientId }), {
    method: "DELETE",
    headers: personHeaders(),
    keepalive: true,
  }).catch(() => undefined); // it ends by itself
}

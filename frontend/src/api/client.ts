/** The typed HTTP client; paths, parameters and answers come from the server's OpenAPI. */

import createClient from "openapi-fetch";
import { personHeaders } from "./person";
import { problemFrom, unreachable } from "./problem";
import type { paths } from "./schema";

export const client = createClient<paths>({ baseUrl: "" });

client.use({
  onRequest({ request }) {
    for (const [name, value] of Object.entries(personHeaders())) request.headers.set(name, value);
    return request;
  },
});

interface Answer<T> {
  data?: T;
  error?: unknown;
  response: Response;
}

/**
 * The body of an answer.
 *
 * @throws RequestFailed with the server's problem document, or code "unreachable" without an answer.
 */
export async function unwrap<T>(asked: Promise<Answer<T>>): Promise<T> {
  let answer: Answer<T>;
  try {
    answer = await asked;
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw unreachable();
  }
  if (!answer.response.ok) throw problemFrom(answer.error, answer.response);
  return answer.data as T;
}

type Query = Record<string, string | number | boolean | null | undefined>;

/** The address of an API path for elements that fetch by themselves, without the values that are absent. */
export function apiUrl(path: string, query: Query = {}): string {
  const parameters = new URLSearchParams();
  for (const [name, value] of Object.entries(query)) {
    if (value !== null && value !== undefined && value !== "") parameters.set(name, String(value));
  }
  const text = parameters.toString();
  return `/api${path}${text ? `?${text}` : ""}`;
}

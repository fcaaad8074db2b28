/** The parts of an OpenAPI 3.1 document that the page shows. */

export interface Schema {
  $ref?: string;
  type?: string;
  format?: string;
  enum?: unknown[];
  const?: unknown;
  default?: unknown;
  example?: unknown;
  examples?: unknown[];
  description?: string;
  anyOf?: Schema[];
  allOf?: Schema[];
  items?: Schema;
  prefixItems?: Schema[];
  properties?: Record<string, Schema>;
  required?: string[];
  additionalProperties?: Schema | boolean;
  minimum?: number;
  maximum?: number;
}

export interface Parameter {
  name: string;
  in: string;
  required?: boolean;
  description?: string;
  schema: Schema;
}

type Content = Record<string, { schema?: Schema; example?: unknown }>;

interface RawOperation {
  operationId: string;
  summary?: string;
  description?: string;
  tags?: string[];
  parameters?: Parameter[];
  requestBody?: { content: Content };
  responses: Record<string, { description?: string; content?: Content }>;
}

export interface OpenApi {
  info: { title: string; version: string; description?: string };
  paths: Record<string, Record<string, RawOperation>>;
  components: { schemas: Record<string, Schema> };
}

export interface Operation extends RawOperation {
  id: string;
  method: string;
  path: string;
  parameters: Parameter[];
}

export interface OperationGroup {
  tag: string;
  operations: Operation[];
}

const METHODS = ["get", "post", "put", "patch", "delete"];
/** In the order of an image's road. */
const TAGS = ["system", "datasets", "images", "runs", "labelling", "cameras", "exports"];

export function operationGroups({ paths }: OpenApi): OperationGroup[] {
  const groups = new Map<string, Operation[]>();
  for (const [path, methods] of Object.entries(paths)) {
    for (const method of METHODS) {
      const raw = methods[method];
      if (!raw) continue;
      const tag = raw.tags?.[0] ?? "other";
      const parameters = (raw.parameters ?? []).filter((parameter) => parameter.in !== "header");
      const operation = { ...raw, id: anchor(method, path), method: method.toUpperCase(), path, parameters };
      groups.set(tag, [...(groups.get(tag) ?? []), operation]);
    }
  }
  const place = (tag: string) => (TAGS.includes(tag) ? TAGS.indexOf(tag) : TAGS.length);
  return [...groups]
    .map(([tag, operations]) => ({ tag, operations }))
    .sort((a, b) => place(a.tag) - place(b.tag));
}

/** "string", "integer, 1 to 500", "open | done | null", "ImageSummary[]". */
export function typeText(schema: Schema): string {
  if (schema.$ref) return refName(schema.$ref);
  if (schema.enum) return schema.enum.map(String).join(" | ");
  if (schema.const !== undefined) return String(schema.const);
  if (schema.anyOf) return schema.anyOf.map(typeText).join(" | ");
  if (schema.allOf?.length === 1 && schema.allOf[0]) return typeText(schema.allOf[0]);
  if (schema.type === "array") return `${schema.items ? typeText(schema.items) : "value"}[]`;
  const name = schema.format === "date-time" ? "time" : (schema.format ?? schema.type ?? "object");
  const { minimum, maximum } = schema;
  if (minimum !== undefined && maximum !== undefined) return `${name}, ${minimum} to ${maximum}`;
  if (minimum !== undefined) return `${name}, at least ${minimum}`;
  return name;
}

export function resolve(document: OpenApi, schema: Schema): Schema {
  if (!schema.$ref) return schema;
  return document.components.schemas[refName(schema.$ref)] ?? {};
}

/** A value of a schema: its example where it has one, else one made from its fields. */
export function exampleOf(document: OpenApi, schema: Schema, depth = 0): unknown {
  const resolved = resolve(document, schema);
  if (resolved.example !== undefined) return resolved.example;
  if (resolved.examples?.length) return resolved.examples[0];
  if (resolved.default !== undefined) return resolved.default;
  if (resolved.const !== undefined) return resolved.const;
  if (resolved.enum) return resolved.enum[0];
  if (resolved.anyOf) return exampleOf(document, resolved.anyOf[0] ?? {}, depth);
  if (resolved.allOf) return exampleOf(document, resolved.allOf[0] ?? {}, depth);
  // Schemas may hold themselves.
  if (depth > 5) return null;
  if (resolved.prefixItems) return resolved.prefixItems.map((item) => exampleOf(document, item, depth + 1));
  if (resolved.type === "array") return [exampleOf(document, resolved.items ?? {}, depth + 1)];
  if (resolved.properties) {
    return Object.fromEntries(
      Object.entries(resolved.properties).map(([name, field]) => [
        name,
        exampleOf(document, field, depth + 1),
      ]),
    );
  }
  return exampleOfType(resolved);
}

function exampleOfType({ type, format, minimum }: Schema): unknown {
  if (format === "date-time") return "2026-05-04T09:30:00Z";
  if (format === "uuid") return "4b0f0c5e-6d8c-4f6e-9d4e-1f7f2f0a6a01";
  if (type === "integer") return minimum ?? 1;
  if (type === "number") return minimum ?? 0.5;
  if (type === "boolean") return false;
  if (type === "string") return "text";
  return type === "null" ? null : {};
}

/** A command line that does the operation on a server. */
export function curlOf(document: OpenApi, operation: Operation, origin: string): string {
  const path = operation.path.replaceAll(/\{(\w+)\}/g, (_, name: string) =>
    name === "slug" ? "my-dataset" : "1",
  );
  const required = operation.parameters.filter((parameter) => parameter.in === "query" && parameter.required);
  const query = required
    .map(({ name, schema }) => `${name}=${String(exampleOf(document, schema))}`)
    .join("&");
  const lines = [
    `curl ${operation.method === "GET" ? "" : `-X ${operation.method} `}${quoted(origin + path + (query ? `?${query}` : ""))}`,
  ];
  const content = operation.requestBody?.content ?? {};
  const json = content["application/json"];
  if (json?.schema) {
    lines.push(
      `-H 'content-type: application/json'`,
      `-d ${quoted(JSON.stringify(exampleOf(document, json.schema)))}`,
    );
  } else if (content["multipart/form-data"]) {
    lines.push("-F 'files=@000000.png;filename=KITTI/000000.png'", "-F files=@000001.png");
  } else if (isBinary(operation)) {
    lines.push("-OJ");
  }
  return lines.join(" \\\n  ");
}

/** The schema of an answer's JSON body. */
export function answerSchema({ responses }: Operation): Schema | null {
  const [, answer] = Object.entries(responses).find(([code]) => code.startsWith("2")) ?? [];
  return answer?.content?.["application/json"]?.schema ?? null;
}

function isBinary({ responses }: Operation): boolean {
  const kinds = Object.keys(responses["200"]?.content ?? {});
  return kinds.length > 0 && !kinds.includes("application/json");
}

function refName(ref: string): string {
  return ref.slice(ref.lastIndexOf("/") + 1);
}

function anchor(method: string, path: string): string {
  return `${method}${path
    .replace(/^\/api/, "")
    .replaceAll(/[{}]/g, "")
    .replaceAll("/", "-")}`;
}

/** For a POSIX shell. */
function quoted(text: string): string {
  return `'${text.replaceAll("'", "'\\''")}'`;
}

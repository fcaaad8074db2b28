import { describe, expect, it } from "vitest";
import description from "../../api/openapi.json";
import { answerSchema, curlOf, exampleOf, type OpenApi, operationGroups, typeText } from "./openapi";

const document = description as unknown as OpenApi;
const operations = operationGroups(document).flatMap((group) => group.operations);
const find = (method: string, path: string) => {
  const operation = operations.find((candidate) => candidate.method === method && candidate.path === path);
  if (!operation) throw new Error(`${method} ${path} is missing`);
  return operation;
};

describe("the server's description", () => {
  it("is shown whole, each operation under an anchor of its own", () => {
    const described = Object.values(document.paths).flatMap((methods) => Object.keys(methods));
    expect(operations).toHaveLength(described.length);
    expect(new Set(operations.map(({ id }) => id)).size).toBe(operations.length);
  });

  it("has an example of each body and answer", () => {
    for (const operation of operations) {
      const answer = answerSchema(operation);
      if (answer) expect(exampleOf(document, answer)).toBeDefined();
    }
    const runs = find("POST", "/api/datasets/{slug}/runs").requestBody?.content["application/json"]?.schema;
    expect(exampleOf(document, runs ?? {})).toMatchObject({ operating_point: "balanced" });
  });

  it("gives a command line for each", () => {
    const create = curlOf(document, find("POST", "/api/datasets"), "http://localhost");
    expect(create).toContain("curl -X POST 'http://localhost/api/datasets'");
    expect(create).toContain(`-d '{"name":`);
    expect(curlOf(document, find("POST", "/api/datasets/{slug}/images"), "")).toContain("-F ");
    expect(curlOf(document, find("GET", "/api/datasets/{slug}/export"), "")).toContain("-OJ");
  });
});

describe("schemas", () => {
  it("have a short text", () => {
    expect(typeText({ $ref: "#/components/schemas/Run" })).toBe("Run");
    expect(typeText({ type: "array", items: { type: "integer" } })).toBe("integer[]");
    expect(typeText({ anyOf: [{ enum: ["a", "b"] }, { type: "null" }] })).toBe("a | b | null");
    expect(typeText({ type: "integer", minimum: 1, maximum: 500 })).toBe("integer, 1 to 500");
  });

  it("may hold themselves", () => {
    const tree: OpenApi = {
      ...document,
      components: { schemas: { Tree: { properties: { child: { $ref: "#/components/schemas/Tree" } } } } },
    };
    expect(() => JSON.stringify(exampleOf(tree, { $ref: "#/components/schemas/Tree" }))).not.toThrow();
  });

  it("keep quotes apart from the shell", () => {
    const schema = { example: { name: "it's" } };
    const operation = {
      ...find("POST", "/api/datasets"),
      requestBody: { content: { "application/json": { schema } } },
    };
    expect(curlOf(document, operation, "")).toContain(`'{"name":"it'\\''s"}'`);
  });
});

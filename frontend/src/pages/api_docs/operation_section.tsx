import { ColumnHeads } from "../../design/column_heads";
import { CopyButton } from "../../design/copy_button";
import {
  answerSchema,
  curlOf,
  exampleOf,
  type OpenApi,
  type Operation,
  type Parameter,
  typeText,
} from "./openapi";

import { Prose, withCode } from "./prose";

interface OperationSectionProps {
  document: OpenApi;
  operation: Operation;
}

export function OperationSection({ document, operation }: OperationSectionProps) {
  const { id, method, path, summary, description, parameters, requestBody, responses } = operation;
  const body = requestBody?.content["application/json"]?.schema;
  const answer = answerSchema(operation);
  return (
    <section className="operation" id={id} aria-labelledby={`${id}-title`}>
      <h3 id={`${id}-title`}>
        <a href={`#${id}`} className="operation__address">
          <span className={`method method--${method.toLowerCase()}`}>{method}</span>
          <code>{path}</code>
        </a>
        <span className="visually-hidden">{summary}</span>
      </h3>
      <div className="operation__prose">{description ? <Prose text={description} /> : <p>{summary}</p>}</div>
      {parameters.length > 0 ? <Parameters parameters={parameters} /> : null}
      <Example title="Command line" text={curlOf(document, operation, window.location.origin)} />
      {body ? <Example title="Request body" text={pretty(exampleOf(document, body))} /> : null}
      {answer ? (
        <details className="operation__answer">
          <summary>
            Answer: <code>{typeText(answer)}</code>
          </summary>
          <Example title="Answer" text={pretty(exampleOf(document, answer))} />
        </details>
      ) : null}
      <ul className="operation__codes" aria-label="Status codes">
        {Object.entries(responses).map(([code, response]) => (
          <li key={code}>
            <span className={`status status--${code[0]}`}>{code}</span> {response.description}
          </li>
        ))}
      </ul>
    </section>
  );
}

function Parameters({ parameters }: { parameters: Parameter[] }) {
  return (
    <table className="operation__parameters">
      <ColumnHeads columns={["Parameter", "Type", "Meaning"]} />
      <tbody>
        {parameters.map((parameter) => (
          <tr key={`${parameter.in} ${parameter.name}`}>
            <td>
              <code>{parameter.name}</code>
              <span className="muted"> {parameter.in}</span>
            </td>
            <td>
              <code>{typeText(parameter.schema)}</code>
            </td>
            <td>
              {withCode(parameter.description ?? "")}
              {parameter.schema.default !== undefined ? (
                <span className="muted"> Default: {String(parameter.schema.default)}.</span>
              ) : null}
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Example({ title, text }: { title: string; text: string }) {
  return (
    <figure className="example">
      <figcaption>
        {title}
        <CopyButton text={text} label={`Copy: ${title.toLowerCase()}`} />
      </figcaption>
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: what scrolls must be reachable by keyboard */}
      <pre tabIndex={0}>{text}</pre>
    </figure>
  );
}

function pretty(value: unknown): string {
  return JSON.stringify(value, null, 2);
}

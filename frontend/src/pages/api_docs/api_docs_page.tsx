import { useQuery } from "@tanstack/react-query";
import { useEffect, useMemo, useState } from "react";
import { problemFrom, unreachable } from "../../api/problem";
import { buttonClass } from "../../design/button";
import { Icon } from "../../design/icons";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState, LoadingState } from "../../design/states";
import { type OpenApi, operationGroups } from "./openapi";
import { OperationSection } from "./operation_section";
import { Prose } from "./prose";
import "./api_docs.css";

const ADDRESS = "/api/openapi.json";

/** The REST API as the server describes it. */
export function ApiDocsPage() {
  const description = useQuery({
    queryKey: ["openapi"],
    queryFn: readDescription,
    staleTime: Number.POSITIVE_INFINITY,
  });
  return (
    <PageFrame crumbs={[{ label: "API" }]}>
      {description.data ? (
        <Documentation document={description.data} />
      ) : description.isError ? (
        <ErrorState error={description.error} onRetry={() => description.refetch()} />
      ) : (
        <LoadingState label="Loading the description of the API" />
      )}
    </PageFrame>
  );
}

function Documentation({ document }: { document: OpenApi }) {
  const [search, setSearch] = useState("");
  const groups = useMemo(() => operationGroups(document), [document]);
  const wanted = search.trim().toLocaleLowerCase();
  const shown = groups
    .map(({ tag, operations }) => ({
      tag,
      operations: operations.filter(({ method, path, description, summary }) =>
        `${tag} ${method} ${path} ${summary ?? ""} ${description ?? ""}`.toLocaleLowerCase().includes(wanted),
      ),
    }))
    .filter(({ operations }) => operations.length > 0);

  // The operation of the address is there only once the description is.
  useEffect(() => {
    const id = decodeURIComponent(window.location.hash.slice(1));
    if (id) window.document.getElementById(id)?.scrollIntoView();
  }, []);

  return (
    <div className="api-docs">
      <nav className="api-docs__index" aria-label="Operations">
        <input
          className="input"
          type="search"
          placeholder="Search"
          aria-label="Search operations"
          value={search}
          onChange={(event) => setSearch(event.target.value)}
        />
        {shown.map(({ tag, operations }) => (
          <div key={tag}>
            <h2>{tag}</h2>
            <ul>
              {operations.map(({ id, method, path }) => (
                <li key={id}>
                  <a href={`#${id}`} title={`${method} ${path}`}>
                    <span className={`method method--${method.toLowerCase()}`}>{method}</span>
                    <span className="api-docs__path">{path.replace("/api", "")}</span>
                  </a>
                </li>
              ))}
            </ul>
          </div>
        ))}
      </nav>
      <div className="api-docs__content">
        <header className="api-docs__intro">
          <div>
            <h1>REST API</h1>
            <a className={buttonClass("default")} href={ADDRESS} download="clearlines-openapi.json">
              <Icon name="download" /> OpenAPI
            </a>
          </div>
          <Prose text={document.info.description ?? ""} />
          <p>
            Lists with <code>next_cursor</code> go on with <code>?cursor=</code>. What is deleted can be
            restored for some days. Requests that change something are taken from this page's own origin, or
            from a client that sends none.
          </p>
        </header>
        {shown.length === 0 ? <EmptyState icon="search" title="No operation fits" /> : null}
        {shown.map(({ tag, operations }) => (
          <section key={tag} aria-label={tag}>
            <h2 className="api-docs__tag">{tag}</h2>
            {operations.map((operation) => (
              <OperationSection key={operation.id} document={document} operation={operation} />
            ))}
          </section>
        ))}
      </div>
    </div>
  );
}

async function readDescription(): Promise<OpenApi> {
  let response: Response;
  try {
    response = await fetch(ADDRESS);
  } catch {
    throw unreachable();
  }
  if (!response.ok) throw problemFrom(await response.json().catch(() => null), response);
  return response.json();
}

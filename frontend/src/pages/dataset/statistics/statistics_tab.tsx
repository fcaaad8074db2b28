import { useQuery } from "@tanstack/react-query";
import { Link } from "react-router";
import { type Statistics, statisticsQuery } from "../../../api/team_endpoints";
import { Bars } from "../../../charts/bars";
import { formatCount, formatDay, formatQuantity } from "../../../design/format";
import { EmptyState, ErrorState } from "../../../design/states";
import { kappaText } from "../team/kappa_text";
import { DecisionTimesSection } from "./decision_times_section";
import { PeopleTable } from "./people_table";
import { ReasonsSection } from "./reasons_section";
import { everyDay, timeText } from "./time_text";
import "../../board_page.css";
import "./statistics.css";

/** How fast the labelling goes, and how well. */
export function StatisticsTab({ slug }: { slug: string }) {
  const { data, isError, error, refetch } = useQuery({ ...statisticsQuery(slug), refetchOnMount: "always" });
  if (isError) return <ErrorState error={error} onRetry={() => refetch()} />;
  if (data === undefined) {
    return <div className="skeleton statistics__loading" role="status" aria-label="Loading statistics" />;
  }
  if (data.decisions === 0) {
    return (
      <EmptyState icon="chart" title="No decisions yet">
        Progress, pace and agreement are shown here once somebody has kept or rejected a candidate.
      </EmptyState>
    );
  }
  return (
    <div className="statistics">
      <Figures statistics={data} />
      <Days statistics={data} />
      <DecisionTimesSection statistics={data} />
      <PeopleTable statistics={data} />
      <ReasonsSection reasons={data.reasons} />
      <p className="muted">
        Agreement and differences are on the <Link to="?tab=team">team's page</Link>, what the suggestions
        have learnt on <Link to={`/datasets/${slug}/suggestions`}>theirs</Link>.
      </p>
    </div>
  );
}

function Figures({ statistics }: { statistics: Statistics }) {
  const { images, decisions, per_hour, times, suggestions, agreement } = statistics;
  const share = suggestions.shown > 0 ? Math.round((100 * suggestions.agreed) / suggestions.shown) : null;
  const figures: [string, string, string][] = [
    [
      "Images done",
      formatCount(images.done),
      `of ${formatCount(images.done + images.open)}, ${formatCount(images.discarded)} discarded`,
    ],
    [
      "Decisions",
      formatCount(decisions),
      per_hour === null ? "" : `${formatCount(Math.round(per_hour))} in an hour of work`,
    ],
    ["Time per decision", timeText(times.median), "median"],
    [
      "Suggestions agreed with",
      share === null ? "–" : `${share} %`,
      suggestions.shown === 0
        ? "none shown yet"
        : `of ${formatCount(suggestions.shown)} shown, ${formatCount(suggestions.accepted)} by S`,
    ],
    [
      "Agreement, κ",
      kappaText(agreement.kappa),
      agreement.reviews === 0
        ? "no image reviewed twice"
        : formatQuantity(agreement.reviews, "second review"),
    ],
  ];
  return (
    <dl className="figures">
      {figures.map(([name, value, note]) => (
        <div key={name} className="card">
          <dt>{name}</dt>
          <dd>
            <strong className="numeric">{value}</strong>
            <span className="muted numeric">{note}</span>
          </dd>
        </div>
      ))}
    </dl>
  );
}

function Days({ statistics }: { statistics: Statistics }) {
  const days = everyDay(statistics.days, (day) => ({ day, decisions: 0, done: 0 }));
  if (days.length === 0) return null;
  const bars = (part: "decisions" | "done") =>
    days.map((entry) => ({ label: entry.day.slice(5), name: formatDay(entry.day), value: entry[part] }));
  return (
    <section className="section card" aria-labelledby="days-title">
      <h2 id="days-title">Day by day</h2>
      <div className="statistics__pair">
        <div>
          <h3>Decisions</h3>
          <Bars label="Decisions by day" bars={bars("decisions")} unit="decisions" />
        </div>
        <div>
          <h3>Images done</h3>
          <Bars label="Images done by day" bars={bars("done")} unit="images" />
        </div>
      </div>
    </section>
  );
}

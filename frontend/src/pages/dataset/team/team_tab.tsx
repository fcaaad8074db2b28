import { useQuery } from "@tanstack/react-query";
import { guidelinesQuery } from "../../../api/queries";
import { agreementQuery, peopleQuery, secondReviewsQuery } from "../../../api/team_endpoints";
import type { Dataset } from "../../../api/types";
import { useRights } from "../../../api/use_rights";
import { ErrorState } from "../../../design/states";
import { AgreementSection } from "./agreement_section";
import { GuidelinesSection } from "./guidelines_section";
import { SecondReviewsSection } from "./second_reviews_section";
import { TasksSection } from "./tasks_section";
import "../../board_page.css";
import "./team.css";

/** Who does what, by which rules, and how far they agree. */
export function TeamTab({ dataset }: { dataset: Dataset }) {
  const { slug } = dataset;
  const rights = useRights();
  const guidelines = useQuery(guidelinesQuery(slug));
  const annotates = rights.label;
  const people = useQuery({ ...peopleQuery(slug), enabled: annotates, refetchOnMount: "always" });
  const seconds = useQuery({ ...secondReviewsQuery(slug), enabled: annotates, refetchOnMount: "always" });
  const agreement = useQuery({ ...agreementQuery(slug), enabled: annotates, refetchOnMount: "always" });
  const failed = [guidelines, people, seconds, agreement].find((query) => query.isError);
  if (failed) return <ErrorState error={failed.error} onRetry={() => failed.refetch()} />;
  if (!guidelines.data || (annotates && !(people.data && seconds.data && agreement.data))) {
    return <div className="skeleton team__loading" role="status" aria-label="Loading the team" />;
  }
  return (
    <div className="team">
      <GuidelinesSection slug={slug} guidelines={guidelines.data} editable={rights.maintain} />
      {people.data ? (
        <TasksSection dataset={dataset} people={people.data} editable={rights.maintain} />
      ) : null}
      {seconds.data ? <SecondReviewsSection slug={slug} seconds={seconds.data} /> : null}
      {agreement.data ? <AgreementSection slug={slug} agreement={agreement.data} /> : null}
    </div>
  );
}

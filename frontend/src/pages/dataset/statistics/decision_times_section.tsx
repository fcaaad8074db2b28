import { useState } from "react";
import type { DecisionTimes, Statistics } from "../../../api/team_endpoints";
import { Bars } from "../../../charts/bars";
import { Segmented } from "../../../design/segmented";
import { binNames, timeText } from "./time_text";

type Choice = "all" | Statistics["verdicts"][number]["verdict"];

const NAMES: Readonly<Record<Choice, string>> = {
  all: "All",
  keep: "Keep",
  reject: "Reject",
  ambiguous: "Ambiguous",
  undecided: "Taken back",
};

/** How long people looked before they decided. */
export function DecisionTimesSection({ statistics }: { statistics: Statistics }) {
  const [choice, setChoice] = useState<Choice>("all");
  const { verdicts, edges } = statistics;
  const times: DecisionTimes = verdicts.find(({ verdict }) => verdict === choice)?.times ?? statistics.times;
  const names = binNames(edges);
  const bars = times.histogram.map((value, index) => ({
    label: names[index]?.label ?? "",
    name: names[index]?.name ?? "",
    value,
  }));
  return (
    <section className="section card" aria-labelledby="times-title">
      <header className="section__header">
        <h2 id="times-title">Time per decision</h2>
        <Segmented
          label="Verdict"
          name="times-verdict"
          value={choice}
          choices={(["all", ...verdicts.map(({ verdict }) => verdict)] as Choice[]).map((value) => ({
            value,
            label: NAMES[value],
          }))}
          onChange={setChoice}
        />
      </header>
      <p className="muted numeric">
        Half of them took {timeText(times.lower_quartile)} to {timeText(times.upper_quartile)}, the median is{" "}
        {timeText(times.median)}. A key press counts once, however many candidates it judged.
      </p>
      <Bars label="Decisions by the time they took" bars={bars} unit="key presses" />
    </section>
  );
}

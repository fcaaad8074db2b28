import { useEffect } from "react";
import type { Recall } from "../../../api/types";
import { Button, IconButton } from "../../../design/button";
import { Icon } from "../../../design/icons";
import { Keys } from "../../../design/kbd";
import "./recall.css";

const ANSWERS: readonly { readonly recall: Recall; readonly label: string; readonly title: string }[] = [
  { recall: "complete", label: "Complete", title: "Every straight line is among the kept ones" },
  { recall: "nearly", label: "Nearly", title: "One or two short ones are missing" },
  { recall: "incomplete", label: "Incomplete", title: "Straight lines are missing" },
];

interface RecallQuestionProps {
  onAnswer: (recall: Recall) => void;
  onClose: () => void;
}

/** How complete an image's labels are, asked when it is done; one digit answers. */
export function RecallQuestion({ onAnswer, onClose }: RecallQuestionProps) {
  useEffect(() => {
    function onKeyDown(event: KeyboardEvent): void {
      const answer =
        event.ctrlKey || event.metaKey || event.altKey ? undefined : ANSWERS[Number(event.key) - 1];
      if (answer === undefined || event.repeat) return;
      // The digits mean something else while nothing is asked.
      event.preventDefault();
      event.stopPropagation();
      onAnswer(answer.recall);
    }
    window.addEventListener("keydown", onKeyDown, { capture: true });
    return () => window.removeEventListener("keydown", onKeyDown, { capture: true });
  }, [onAnswer]);

  return (
    <div className="banner banner--wrapping recall-question" role="status">
      <Icon name="question" />
      <span>Are all straight lines of this image kept?</span>
      <span className="recall-question__answers">
        {ANSWERS.map(({ recall, label, title }, index) => (
          <Button key={recall} small title={title} onClick={() => onAnswer(recall)}>
            {label} <Keys keys={[String(index + 1)]} />
          </Button>
        ))}
      </span>
      <IconButton small icon="cross" label="Not done yet" keys={["Esc"]} side="end" onClick={onClose} />
    </div>
  );
}

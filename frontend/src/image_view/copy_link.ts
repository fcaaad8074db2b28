import { toast } from "../design/toast";

/** Copies an address and says so. */
export async function copyLink(address: string, message: string): Promise<void> {
  const copied = await navigator.clipboard?.writeText(address).then(
    () => true,
    () => false,
  );
  toast({
    key: "link",
    message: copied ? message : "This browser doesn't let the page copy",
    tone: copied ? "success" : "danger",
  });
}

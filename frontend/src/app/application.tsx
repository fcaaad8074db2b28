import { QueryClientProvider } from "@tanstack/react-query";
import { RouterProvider } from "react-router/dom";
import { makeQueryClient } from "../api/queries";
import { Toaster } from "../design/toast";
import { makeRouter } from "./routes";

const queryClient = makeQueryClient();
const router = makeRouter();

export function Application() {
  return (
    <QueryClientProvider client={queryClient}>
      <RouterProvider router={router} />
      <Toaster />
    </QueryClientProvider>
  );
}

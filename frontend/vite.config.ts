import react from "@vitejs/plugin-react";
import { defineConfig } from "vitest/config";

export default defineConfig({
  plugins: [react()],
  base: "/",
  build: {
    outDir: "../app/static",
    emptyOutDir: true,
    target: "es2023",
    // The server reads in it which files a page is made of, and names them with the first answer.
    manifest: "manifest.json",
    // Inlined data: addresses would need a wider content security policy than 'self'.
    assetsInlineLimit: 0,
    rolldownOptions: {
      output: {
        codeSplitting: {
          // Few files: what pages share in small pieces would cost a request for each.
          groups: [
            { name: "framework", test: /rolldown|node_modules[\\/](?!flat)/, priority: 3 },
            {
              name: "common",
              test: /src[\\/](api|app|design|labelling|uploads|charts[\\/]use)/,
              priority: 2,
              minShareCount: 2,
            },
            {
              name: "image",
              test: /src[\\/](canvas|image_view)[\\/]|[\\/]flat/,
              priority: 1,
              minShareCount: 2,
            },
          ],
        },
      },
    },
  },
  server: {
    port: 5173,
    proxy: { "/api": "http://127.0.0.1:8765" },
  },
  test: {
    environment: "node",
    isolate: false,
    include: ["src/**/*.test.ts"],
  },
});

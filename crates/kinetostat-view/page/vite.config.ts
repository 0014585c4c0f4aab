import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// One file without a network: the page is part of the program.
export default defineConfig({
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  build: { outDir: "../bundle", emptyOutDir: true, target: "es2022" },
});

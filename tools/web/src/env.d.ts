// SPDX-License-Identifier: MIT
declare module '*?base64' {
  const text: string;
  export default text;
}
declare module '*.glsl?raw' {
  const text: string;
  export default text;
}

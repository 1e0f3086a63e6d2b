// Programs of the graphics processor, from the files beside this one.

function compiled(gl, type, text) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  return shader;
}

// {program, at: its uniforms by name}. Throws where the driver refuses it.
export function programOf(gl, vertex, fragment) {
  const program = gl.createProgram();
  const shaders = [compiled(gl, gl.VERTEX_SHADER, vertex), compiled(gl, gl.FRAGMENT_SHADER, fragment)];
  for (const shader of shaders) gl.attachShader(program, shader);
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
    throw new Error([gl.getProgramInfoLog(program), ...shaders.map((s) => gl.getShaderInfoLog(s))].join("\n"));
  for (const shader of shaders) gl.deleteShader(shader);
  const at = {};
  const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) || 0;
  for (let k = 0; k < count; ++k) {
    const { name } = gl.getActiveUniform(program, k);
    at[name] = gl.getUniformLocation(program, name);
  }
  return { program, at };
}

// Shaders with a word defined. Where the driver lets a shader promise that depths only grow, what is hidden costs nothing.
export function exact(gl, text) {
  let head = "#define EXACT\n";
  if (text.includes("gl_FragDepth") && gl.getExtension("EXT_conservative_depth"))
    head = "#extension GL_EXT_conservative_depth : require\n" + head;
  const promise = head.startsWith("#extension") ? "layout(depth_greater) out highp float gl_FragDepth;\n" : "";
  return text.replace("#version 300 es\n", "#version 300 es\n" + head)
    .replace("precision highp float;\n", "precision highp float;\n" + promise);
}

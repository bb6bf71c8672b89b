// The one light rig: a head light a little above the viewer's left shoulder, a soft sky about the world's up, a weak light
// from the other side that draws the rim, and highlights after Cook and Torrance with GGX.

const float kPi = 3.14159265;
const vec3 kKeyDirection = vec3(-0.50, 0.62, 0.60);   // eye space
const vec3 kKeyColor = vec3(1.00, 0.95, 0.87) * 2.7;
const vec3 kRimDirection = vec3(0.72, 0.18, -0.67);
const vec3 kRimColor = vec3(0.60, 0.75, 1.00) * 0.5;
const vec3 kSky = vec3(0.50, 0.63, 0.86);
const vec3 kGround = vec3(0.20, 0.15, 0.12);

float fifth_power(float x) {
  float square = x * x;
  return square * square * x;
}

float highlight(float n_h, float n_v, float n_l, float roughness) {
  float a = roughness * roughness;
  float a2 = a * a;
  float d = n_h * n_h * (a2 - 1.0) + 1.0;
  float distribution = a2 / (kPi * d * d);
  float k = 0.5 * a;
  float visibility = 0.25 / ((n_v * (1.0 - k) + k) * (n_l * (1.0 - k) + k));
  return distribution * visibility;
}

vec3 lit_by(vec3 l, vec3 radiance, vec3 n, vec3 v, vec3 diffuse, vec3 specular, float roughness) {
  float n_l = dot(n, l);
  if (n_l <= 0.0) return vec3(0.0);
  vec3 h = normalize(l + v);
  float v_h = max(dot(v, h), 0.0);
  vec3 fresnel = specular + (1.0 - specular) * fifth_power(1.0 - v_h);
  float shine = highlight(max(dot(n, h), 0.0), max(dot(n, v), 1e-3), n_l, roughness);
  return radiance * n_l * ((1.0 - fresnel) * diffuse / kPi + fresnel * shine);
}

vec3 sky(vec3 direction, vec3 up) {
  float t = 0.5 + 0.5 * dot(direction, up);
  return mix(kGround, kSky, t * t * (3.0 - 2.0 * t));
}

/// Brings light beyond a knee smoothly below 1, so that highlights keep their shape.
vec3 soften(vec3 c) {
  const float knee = 0.72;
  vec3 over = max(c - knee, vec3(0.0));
  return min(c, vec3(knee)) + (1.0 - knee) * (1.0 - exp(-over / (1.0 - knee)));
}

vec3 shade(vec3 n, vec3 v, vec3 base, float metallic, float roughness, vec3 up) {
  float rough = clamp(roughness, 0.12, 1.0);
  vec3 diffuse = base * (1.0 - metallic);
  vec3 specular = mix(vec3(0.04), base, metallic);
  vec3 c = lit_by(normalize(kKeyDirection), kKeyColor, n, v, diffuse, specular, rough);
  c += lit_by(normalize(kRimDirection), kRimColor, n, v, diffuse, specular, rough);
  float n_v = max(dot(n, v), 0.0);
  vec3 mirror = specular + (max(vec3(1.0 - rough), specular) - specular) * fifth_power(1.0 - n_v);
  // A surface that turns away is darkened a little, so that outlines read against a white page.
  float turned = mix(0.45, 1.0, smoothstep(0.0, 0.6, n_v));
  c += diffuse * sky(n, up) * 0.42;
  c += mirror * sky(reflect(-v, n), up) * 0.5;
  c *= turned;
  return soften(c);
}

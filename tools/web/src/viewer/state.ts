// SPDX-License-Identifier: MIT
import { lightWindows, type LightWindow } from '../windows';

export type Show = 'picture' | 'charts' | 'coefficient' | 'normals';
export type Technique = 'transfer' | 'phong' | 'normal-map';
export type LightKind = 'sun' | 'soft' | 'sky' | 'even' | 'none';
export type EnvironmentName = 'none' | 'overcast' | 'sunset' | 'studio' | 'file';

/** All that a person can choose. Angles are degrees. */
export interface State {
  show: Show;
  technique: Technique;
  coefficient: number;
  wireframe: boolean;
  light: LightKind;
  azimuth: number;
  elevation: number;
  softness: number;
  strength: number;
  color: string;
  fill: number;
  environment: EnvironmentName;
  environmentTurn: number;
  environmentStrength: number;
  window: LightWindow;
  /** 0: as many as the asset has. */
  bands: number;
  /** Stops. */
  exposure: number;
  compare: boolean;
  /** Part of the picture's width that is drawn with transfer. */
  split: number;
  /** What a drag moves. */
  drag: 'view' | 'light';
}

export const firstState: Readonly<State> = {
  show: 'picture', technique: 'transfer', coefficient: 1, wireframe: false,
  light: 'sun', azimuth: -45, elevation: 35, softness: 25, strength: 1, color: '#ffffff', fill: 0.08,
  environment: 'none', environmentTurn: 0, environmentStrength: 1,
  window: lightWindows[0], bands: 0, exposure: 0, compare: false, split: 0.5, drag: 'view',
};

/** A state that tells of its changes. */
export class Store {
  readonly state: State = { ...firstState };
  private readonly listeners: ((changed: ReadonlySet<keyof State>) => void)[] = [];

  set(change: Partial<State>): void {
    const changed = new Set<keyof State>();
    for (const key of Object.keys(change) as (keyof State)[])
      if (this.state[key] !== change[key]) changed.add(key);
    Object.assign(this.state, change);
    if (changed.size > 0) for (const listener of this.listeners) listener(changed);
  }

  /** Calls back after each change, and once at the start with every key. */
  watch(listener: (changed: ReadonlySet<keyof State>) => void): void {
    this.listeners.push(listener);
    listener(new Set(Object.keys(this.state) as (keyof State)[]));
  }
}
